// SPDX-License-Identifier: GPL-3.0-or-later
// All operations of which the programs of materials are made.
#pragma once

#include <variant>

#include "shading/bevel_operation.h"
#include "shading/color_operations.h"
#include "shading/gabor_operation.h"
#include "shading/ies_operation.h"
#include "shading/math_operations.h"
#include "shading/noise_operations.h"
#include "shading/occlusion_operation.h"
#include "shading/surface_operations.h"
#include "shading/texture_operations.h"
#include "shading/vector_operations.h"
#include "shading/voronoi_operation.h"

namespace basicrt {

// Each gives three numbers; one that gives a single number gives it thrice, so that it is grey where a colour is wanted.
using Operation =
    std::variant<MathOperation, VectorMathOperation, MapRangeOperation, ComponentOperation, CombineOperation,
                 MixOperation, TableOperation, ConvertColorOperation, HueSaturationOperation, ToneOperation,
                 MappingOperation, RotateOperation, TransformOperation, ChangeSpaceOperation, SurfaceOperation,
                 AttributeOperation, FresnelOperation, NormalMapOperation, TangentOperation, WireframeOperation,
                 BumpOperation, ImageOperation, CheckerOperation, GradientOperation, WaveOperation, MagicOperation,
                 BrickOperation, NoiseOperation, WhiteNoiseOperation, VoronoiOperation, GaborOperation,
                 AmbientOcclusionOperation, BevelOperation, IesOperation, ObjectPropertyOperation>;

}  // namespace basicrt

// SPDX-License-Identifier: GPL-3.0-or-later
// The operations of materials' programs, and the reference to the value of one.
#include "described.h"
#include "register.h"
#include "shading/operation.h"

namespace basicrt::bindings {
namespace py = pybind11;

void register_operations(py::module_& m) {
  py::class_<OperationIndex>(m, "OperationRef", "Stands for the value of one of a material's operations.")
      .def(py::init([](std::uint32_t index) { return OperationIndex{index}; }), py::arg("index"))
      .def_readonly("index", &OperationIndex::index)
      .def("__eq__",
           [](const OperationIndex& self, const py::object& other) {
             return py::isinstance<OperationIndex>(other) && other.cast<const OperationIndex&>() == self;
           })
      .def("__hash__", [](const OperationIndex& self) { return py::hash(py::int_(self.index)); })
      .def("__repr__", [](const OperationIndex& self) { return "OperationRef(" + std::to_string(self.index) + ")"; });

  bind_described<MathOperation>(m, "MathOperation", "A number from up to three.");
  bind_described<VectorMathOperation>(m, "VectorMathOperation", "A vector, or a number, from up to three vectors.");
  bind_described<MapRangeOperation>(m, "MapRangeOperation", "Numbers from one range to another.");
  bind_described<ComponentOperation>(m, "ComponentOperation", "A number of a vector or colour.");
  bind_described<CombineOperation>(m, "CombineOperation", "A vector or colour of three numbers.");
  bind_described<MixOperation>(m, "MixOperation", "Two colours blended.");
  bind_described<TableOperation>(m, "TableOperation", "Colours looked up by their channels.");
  bind_described<ConvertColorOperation>(m, "ConvertColorOperation", "A colour in another model.");
  bind_described<HueSaturationOperation>(m, "HueSaturationOperation", "A colour with another hue, saturation, value.");
  bind_described<ToneOperation>(m, "ToneOperation", "A colour with each channel changed.");
  bind_described<MappingOperation>(m, "MappingOperation", "A point scaled, rotated and moved.");
  bind_described<RotateOperation>(m, "RotateOperation", "A point rotated.");
  bind_described<TransformOperation>(m, "TransformOperation", "A point transformed by a matrix.");
  bind_described<ChangeSpaceOperation>(m, "ChangeSpaceOperation", "A point from one space to another.");
  bind_described<SurfaceOperation>(m, "SurfaceOperation", "Something of the point that is shaded.");
  bind_described<AttributeOperation>(m, "AttributeOperation", "A named attribute of the mesh.");
  bind_described<ObjectPropertyOperation>(m, "ObjectPropertyOperation", "A named property of the object.");
  bind_described<FresnelOperation>(m, "FresnelOperation", "A weight by the angle of view.");
  bind_described<NormalMapOperation>(m, "NormalMapOperation", "A normal from a colour.");
  bind_described<TangentOperation>(m, "TangentOperation", "A direction along the surface.");
  bind_described<AmbientOcclusionOperation>(m, "AmbientOcclusionOperation", "How open the surroundings are.");
  bind_described<BevelOperation>(m, "BevelOperation", "A normal that turns around edges.");
  bind_described<WireframeOperation>(m, "WireframeOperation", "1 near the edges of triangles.");
  bind_described<BumpOperation>(m, "BumpOperation", "A normal from a height.");
  bind_described<ImageOperation>(m, "TextureOperation", "A texture of the scene at any coordinates.");
  bind_described<CheckerOperation>(m, "CheckerOperation", "1 and 0 by turns.");
  bind_described<GradientOperation>(m, "GradientOperation", "A number that rises from 0 to 1.");
  bind_described<WaveOperation>(m, "WaveOperation", "Bands or rings.");
  bind_described<MagicOperation>(m, "MagicOperation", "Colours in waves.");
  bind_described<BrickOperation>(m, "BrickOperation", "x: the mortar, y: the tint of the brick.");
  bind_described<NoiseOperation>(m, "NoiseOperation", "Smooth noise.");
  bind_described<WhiteNoiseOperation>(m, "WhiteNoiseOperation", "A random number for each point.");
  bind_described<VoronoiOperation>(m, "VoronoiOperation", "Cells around random points.");
  bind_described<GaborOperation>(m, "GaborOperation", "Waves of one frequency in random places.");
  bind_described<IesOperation>(m, "IesOperation", "How a luminaire spreads its light.");
}

}  // namespace basicrt::bindings

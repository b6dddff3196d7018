// SPDX-License-Identifier: GPL-3.0-or-later
// Holds docs/scene.schema.json against the reader: described structs field by field, everything else by its keys.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <set>

#include "io/described_json.h"
#include "io/file.h"
#include "io/scene_text.h"

namespace basicrt {
namespace {

const std::filesystem::path schema_path = std::filesystem::path(BASICRT_SOURCE_DIR) / "docs/scene.schema.json";

const Json& schema() {
  static const Json json = parse_json(read_file(schema_path), schema_path.string());
  return json;
}

Json range_schema(const char* type, const Range& range) {
  Json json = {{"type", type}};
  const auto number = [&](double value) -> Json {
    return value == std::floor(value) ? Json(static_cast<std::int64_t>(value)) : Json(value);
  };
  if (std::isfinite(range.minimum))
    json[range.is_minimum_excluded ? "exclusiveMinimum" : "minimum"] = number(range.minimum);
  if (std::isfinite(range.maximum)) json["maximum"] = number(range.maximum);
  return json;
}

Json vector_schema(int size, const Range& range) {
  return {{"type", "array"}, {"items", range_schema("number", range)}, {"minItems", size}, {"maxItems", size}};
}

template <class Input>
constexpr auto input_name = std::same_as<Input, ColorInput> ? "#/$defs/vector_input" : "#/$defs/number_input";

// A constant within a range, a texture or an operation.
template <class Input>
Json input_schema(const Range& range) {
  const Json operation = {{"$ref", "#/$defs/operation_value"}};
  if constexpr (std::same_as<Input, NumberInput>)
    return {{"oneOf", {range_schema("number", range), {{"$ref", "#/$defs/texture_share"}}, operation}}};
  else
    return {{"oneOf", {vector_schema(3, range), {{"description", "a texture's name"}, {"type", "string"}}, operation}}};
}

// What JSON a field of that type takes.
template <class Value>
Json value_schema(const Range& range) {
  if constexpr (std::same_as<Value, bool>)
    return {{"type", "boolean"}};
  else if constexpr (std::same_as<Value, NodeIndex>)
    return {{"$ref", "#/$defs/node_input"}};
  else if constexpr (std::integral<Value>)
    return range_schema("integer", range);
  else if constexpr (std::floating_point<Value>)
    return range_schema("number", range);
  else if constexpr (std::same_as<Value, Vec2f>)
    return vector_schema(2, range);
  else if constexpr (std::same_as<Value, Vec3f>)
    return vector_schema(3, range);
  else if constexpr (std::same_as<Value, Transform>)
    return {{"$ref", "#/$defs/transform"}};
  else if constexpr (std::same_as<Value, std::vector<Transform>>)
    return {{"type", "array"}, {"items", {{"$ref", "#/$defs/transform"}}}};
  else if constexpr (std::same_as<Value, LinkSets>)
    return {{"$ref", "#/$defs/link_sets"}};
  else if constexpr (std::same_as<Value, std::vector<float>>)
    return {{"type", "array"}, {"items", range_schema("number", range)}};
  else if constexpr (IsInput<Value>)
    return range == Range{} ? Json{{"$ref", input_name<Value>}} : input_schema<Value>(range);
  else if constexpr (std::same_as<Value, std::string> || std::same_as<Value, Id<Texture>> ||
                     std::same_as<Value, Id<Material>>)
    return {{"type", "string"}};
  else
    return {{"enum", enum_names<Value>}};
}

// A described struct as the schema should have it. `extra` are keys that the reader adds to it.
template <class Struct>
Json definition_of(const Json& extra = Json::object()) {
  Json properties = Json::object();
  if constexpr (IsKind<Struct>) properties["type"] = {{"const", Struct::kind}};
  for_each_field<Struct>([&]<class Value>(const Field<Struct, Value>& field) {
    Json property = {{"description", field.doc}};
    property.update(value_schema<Value>(field.range));
    properties[std::string(field.name)] = property;
  });
  properties.update(extra);
  Json definition = {{"type", "object"}, {"properties", properties}};
  if (IsKind<Struct>) definition["required"] = {"type"};
  definition["additionalProperties"] = false;
  return definition;
}

template <class Shader>
bool has_one_color() {
  int count = 0;
  for_each_field<Shader>([&]<class Value>(const Field<Shader, Value>& field) {
    count += std::same_as<Value, ColorInput> && field.name != "normal";
  });
  return count == 1;
}

template <class Variant, class Visitor>
void for_each_kind(Visitor&& visit) {
  for (std::size_t i = 0; i < std::variant_size_v<Variant>; ++i) VariantKinds<Variant>::visit_index(i, visit);
}

// An image where it is given.
Json image_properties() {
  const Json size = {{"type", "integer"}, {"minimum", 1}};
  return {{"path", {{"description", "an image file, relative to this file"}, {"type", "string"}}},
          {"width", size},
          {"height", size},
          {"channels", {{"type", "integer"}, {"minimum", 1}, {"maximum", 4}}},
          {"pixels",
           {{"description", "scene-linear, row 0 at the bottom"}, {"type", "array"}, {"items", {{"type", "number"}}}}},
          {"bytes",
           {{"description", "in place of pixels: 255 is 1"},
            {"type", "array"},
            {"items", {{"type", "integer"}, {"minimum", 0}, {"maximum", 255}}}}},
          {"encoding", {{"description", "how bytes stand for colour"}, {"enum", enum_names<ByteEncoding>}}}};
}

// Every definition that follows from described structs, by its name.
Json expected_definitions() {
  Json definitions = Json::object();
  const Json texture_name = {
      {"texture_name", {{"description", "a texture in place of the colour"}, {"type", "string"}}}};
  for_each_kind<ShaderNode>([&]<class Shader>(const Shader&) {
    const Json extra = has_one_color<Shader>() ? texture_name : Json::object();
    definitions[std::string(Shader::kind) + "_shader"] = definition_of<Shader>(extra);
  });
  Json operations = Json::array();
  for_each_kind<Operation>([&]<class Kind>(const Kind&) {
    const std::string name = std::string(Kind::kind) + "_operation";
    definitions[name] = definition_of<Kind>();
    operations.push_back({{"$ref", "#/$defs/" + name}});
  });
  definitions["operation"] = {{"oneOf", operations}};
  for_each_kind<Light>(
      [&]<class Kind>(const Kind&) { definitions[std::string(Kind::kind) + "_light"] = definition_of<Kind>(); });
  for_each_kind<Camera>(
      [&]<class Kind>(const Kind&) { definitions[std::string(Kind::kind) + "_camera"] = definition_of<Kind>(); });
  for_each_kind<Sky>(
      [&]<class Kind>(const Kind&) { definitions[std::string(Kind::kind) + "_sky"] = definition_of<Kind>(); });
  definitions["vector_input"] = input_schema<ColorInput>({});
  definitions["number_input"] = input_schema<NumberInput>({});
  definitions["constant_texture"] = definition_of<ConstantTexture>();
  definitions["checkerboard_texture"] =
      definition_of<CheckerboardTexture>({{"tex_coordinate_generator", {{"$ref", "#/$defs/texture_generator"}}}});
  Json image_texture = image_properties();
  image_texture["image"] = {{"$ref", "#/$defs/image_input"}};
  definitions["image_texture"] = definition_of<ImageTexture>(image_texture);
  definitions["image"] = {{"type", "object"}, {"properties", image_properties()}, {"additionalProperties", false}};
  definitions["environment_layer"] = definition_of<EnvironmentLayer>(
      {{"image", {{"$ref", "#/$defs/image_input"}}}, {"sky", {{"$ref", "#/$defs/sky"}}}});
  definitions["sphere_shape"] = definition_of<Sphere>();
  definitions["filter"] = definition_of<FilterSettings>();
  definitions["environment"] =
      definition_of<Environment>({{"layers", {{"type", "array"}, {"items", {{"$ref", "#/$defs/environment_layer"}}}}}});
  Json pass_names = Json::array();
  for (const PassInfo& info : passes) pass_names.push_back(info.name);
  definitions["settings"] = definition_of<RenderSettings>(
      {{"filter", {{"$ref", "#/$defs/filter"}}}, {"passes", {{"type", "array"}, {"items", {{"enum", pass_names}}}}}});
  return definitions;
}

TEST(SceneSchema, described_structs_stand_in_it_field_by_field) {
  const Json expected = expected_definitions();
  if (const char* path = std::getenv("BASICRT_DEFINITIONS")) std::ofstream(path) << expected.dump();
  for (const auto& [name, definition] : expected.items()) {
    ASSERT_TRUE(schema()["$defs"].contains(name)) << "no \"" << name << "\": run tools/update_schema.py";
    EXPECT_EQ(schema()["$defs"][name].dump(2), definition.dump(2)) << name << ": run tools/update_schema.py";
  }
}

std::set<std::string> kinds_in(const Json& choices) {
  std::set<std::string> names;
  for (const Json& choice : choices) names.insert(choice["$ref"].get<std::string>().substr(8));  // "#/$defs/"
  return names;
}

template <class Variant>
std::set<std::string> kinds_of(const std::string& group) {
  std::set<std::string> names;
  for (const std::string_view kind : VariantKinds<Variant>::names) names.insert(std::string(kind) + "_" + group);
  return names;
}

TEST(SceneSchema, has_every_kind_and_no_other) {
  EXPECT_EQ(kinds_in(schema()["$defs"]["shader"]["oneOf"]), kinds_of<ShaderNode>("shader"));
  EXPECT_EQ(kinds_in(schema()["$defs"]["texture"]["oneOf"]), kinds_of<Texture>("texture"));
  EXPECT_EQ(kinds_in(schema()["properties"]["lights"]["items"]["oneOf"]), kinds_of<Light>("light"));
  EXPECT_EQ(kinds_in(schema()["$defs"]["sky"]["oneOf"]), kinds_of<Sky>("sky"));
  std::set<std::string> cameras = kinds_of<Camera>("camera");
  cameras.insert("look_at_camera");
  EXPECT_EQ(kinds_in(schema()["properties"]["camera"]["oneOf"]), cameras);
}

// The keys that the reader knows, from its answer to one that it can't know. `scene` has a % in their place.
std::set<std::string> reader_keys(std::string scene) {
  scene.replace(scene.find('%'), 1, R"("?????????????????????": 0)");
  const std::string problem = load_problem_of(scene);
  EXPECT_NE(problem.find("unknown key; known are "), std::string::npos) << problem;
  std::set<std::string> keys;
  for (std::size_t begin = problem.find("known are ");;) {
    begin = problem.find('"', begin + 1);
    if (begin == std::string::npos) return keys;
    const std::size_t end = problem.find('"', begin + 1);
    keys.insert(problem.substr(begin + 1, end - begin - 1));
    begin = end;
  }
}

std::set<std::string> schema_keys(const Json& definition) {
  EXPECT_EQ(definition["additionalProperties"], Json(false));
  std::set<std::string> keys;
  for (const auto& [key, value] : definition["properties"].items()) keys.insert(key);
  return keys;
}

TEST(SceneSchema, has_the_reader_s_keys_and_no_others) {
  const Json& defs = schema()["$defs"];
  EXPECT_EQ(schema_keys(schema()), reader_keys("{%}"));
  const std::pair<const char*, const char*> places[] = {
      {"film", R"({"film": {%}})"},
      {"filter", R"({"film": {"filter": {%}}})"},
      {"settings", R"({"settings": {%}})"},
      {"path_integrator", R"({"integrator": {"type": "path", %}})"},
      {"intersection_test_integrator", R"({"integrator": {"type": "intersection_test", %}})"},
      {"look_at_camera", R"({"camera": {%}})"},
      {"perspective_camera", R"({"camera": {"type": "perspective", %}})"},
      {"environment_map", R"({"environment_map": {%}})"},
      {"environment", R"({"environment": {%}})"},
      {"environment_layer", R"({"environment": {"layers": [{%}]}})"},
      {"image", R"({"images": {"a": {%}}})"},
      {"checkerboard_texture", R"({"textures": {"a": {"type": "checkerboard", %}}})"},
      {"texture_generator", R"({"textures": {"a": {"type": "checkerboard", "tex_coordinate_generator": {%}}}})"},
      {"image_texture", R"({"textures": {"a": {"type": "image", %}}})"},
      {"diffuse_shader", R"({"materials": {"a": {"type": "diffuse", %}}})"},
      {"glass_shader", R"({"materials": {"a": {"type": "glass", %}}})"},
      {"node_material", R"({"materials": {"a": {"nodes": [], %}}})"},
      {"mesh_shape", R"({"shapes": {"a": {"type": "mesh", %}}})"},
      {"sphere_shape", R"({"shapes": {"a": {"type": "sphere", %}}})"},
      {"points_shape", R"({"shapes": {"a": {"type": "points", %}}})"},
      {"curves_shape", R"({"shapes": {"a": {"type": "curves", %}}})"},
      {"points_object", R"({"objects": [{"type": "points", %}]})"},
      {"curves_object", R"({"objects": [{"type": "curves", %}]})"},
      {"mesh_object", R"({"objects": [{"type": "mesh", %}]})"},
      {"sphere_object", R"({"objects": [{"type": "sphere", %}]})"},
      {"shape_object", R"({"shapes": {"a": {"type": "sphere"}}, "objects": [{"shape": "a", %}]})"},
      {"sun_light", R"({"lights": [{"type": "sun", %}]})"},
  };
  for (const auto& [name, scene] : places) EXPECT_EQ(schema_keys(defs[name]), reader_keys(scene)) << name;
  EXPECT_EQ(schema_keys(defs["mesh_object"]["properties"]["light"]),
            reader_keys(R"({"objects": [{"type": "sphere", "light": {"type": "area", %}}]})"));
}

}  // namespace
}  // namespace basicrt

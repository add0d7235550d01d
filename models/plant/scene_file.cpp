#include "plant/scene_file.hpp"

namespace interlock::plant {
namespace {

constexpr double kMostCountsPerUnit = 1e6;
constexpr double kDeepest = 1000;

NeedleAxis read_needle_axis(Reader& reader, const toml::table& table, const ilk_config_t& robot) {
  NeedleAxis axis;
  reader.only(table, {"slot", "counts_per_unit"});
  std::uint32_t slot = 0;
  if (!reader.integer(table, "slot", {0, ILK_SLOTS - 1}, slot) || !drives_motor(robot.axis[slot].card)) {
    reader.fail(table, "slot", "expected the slot of a motor card of the robot");
  }
  if (!reader.number(table, "counts_per_unit", {1e-3, kMostCountsPerUnit}, axis.counts_per_unit)) {
    reader.fail(table, "counts_per_unit", "expected the counts of a mm or rad, above 0");
  }
  axis.slot = slot;
  return axis;
}

ForceInput read_force_input(Reader& reader, const toml::table& table, const Parameters& parameters) {
  ForceInput force;
  reader.only(table, {"slot", "adc", "counts_per_newton"});
  std::uint32_t slot = 0;
  std::uint32_t adc = 0;
  const bool named = reader.integer(table, "slot", {0, ILK_SLOTS - 1}, slot) &&
                     reader.integer(table, "adc", {1, wire::kAnalogInputs}, adc);
  if (!named || !parameters.sensor[slot].input[adc - 1]) {
    reader.fail(table, "adc", "expected a connected input of a [[sensor]], by slot and adc");
    return force;
  }
  if (!reader.number(table, "counts_per_newton", {-1e4, 1e4}, force.counts_per_newton)) {
    reader.fail(table, "counts_per_newton", "expected the counts of a newton");
  }
  force.slot = slot;
  force.input = adc - 1;
  return force;
}

void read_needle(Reader& reader, const toml::table& table, const ilk_config_t& robot,
                 const Parameters& parameters, SceneParameters& scene) {
  reader.only(table, {"entry_mm", "curvature_per_mm", "wander_rad", "bevel_rad", "torsion_play_rad",
                      "windup_rad_per_mm", "texture_n", "insertion", "rotation", "hand", "tip"});
  reader.number(table, "entry_mm", {0, kDeepest}, scene.entry_mm);
  reader.number(table, "curvature_per_mm", {0, 0.1}, scene.curvature_per_mm);
  reader.number(table, "wander_rad", {0, 0.1}, scene.wander_rad);
  reader.number(table, "bevel_rad", {-4, 4}, scene.bevel_rad);
  reader.number(table, "torsion_play_rad", {0, 4}, scene.torsion_play_rad);
  reader.number(table, "windup_rad_per_mm", {0, 0.1}, scene.windup_rad_per_mm);
  reader.number(table, "texture_n", {0, 10}, scene.texture_n);
  for (const char* part : {"insertion", "rotation", "hand", "tip"}) {
    if (!table.contains(part)) {
      reader.fail(table, part, "expected a table [needle." + std::string(part) + "]");
    }
  }
  scene.insertion = read_needle_axis(reader, reader.section(table, "insertion"), robot);
  scene.rotation = read_needle_axis(reader, reader.section(table, "rotation"), robot);
  scene.hand = read_force_input(reader, reader.section(table, "hand"), parameters);
  scene.tip = read_force_input(reader, reader.section(table, "tip"), parameters);
}

void read_layers(Reader& reader, const toml::table& document, SceneParameters& scene) {
  for (const toml::table* table : reader.tables(document, "layer")) {
    TissueLayer layer;
    reader.only(*table, {"thickness_mm", "cutting_n", "stiffness_n_per_mm", "friction_n_per_mm"});
    reader.number(*table, "thickness_mm", {0.1, kDeepest}, layer.thickness_mm);
    reader.number(*table, "cutting_n", {0, 100}, layer.cutting_n);
    reader.number(*table, "stiffness_n_per_mm", {0, 100}, layer.stiffness_n_per_mm);
    reader.number(*table, "friction_n_per_mm", {0, 10}, layer.friction_n_per_mm);
    scene.layers.push_back(layer);
  }
  if (scene.layers.empty()) {
    scene.layers.emplace_back();
  }
}

void read_membranes(Reader& reader, const toml::table& document, SceneParameters& scene) {
  double least = 0;
  for (const toml::table* table : reader.tables(document, "membrane")) {
    TissueMembrane membrane;
    reader.only(*table, {"depth_mm", "stiffness_n_per_mm", "puncture_n"});
    if (!reader.number(*table, "depth_mm", {least, kDeepest}, membrane.depth_mm)) {
      reader.fail(*table, "depth_mm", "expected the depth of the membrane, one after the other");
    }
    reader.number(*table, "stiffness_n_per_mm", {0.01, 100}, membrane.stiffness_n_per_mm);
    reader.number(*table, "puncture_n", {0.01, 100}, membrane.puncture_n);
    least = membrane.depth_mm;
    scene.membranes.push_back(membrane);
  }
}

void read_target(Reader& reader, const toml::table& table, SceneParameters& scene) {
  reader.only(table, {"position_mm", "dragged_share"});
  reader.number(table, "dragged_share", {0, 1}, scene.dragged_share);
  const toml::array* position = table["position_mm"].as_array();
  if (!table.contains("position_mm")) {
    return;
  }
  if (position == nullptr || position->size() != scene.target_mm.size()) {
    reader.fail(table, "position_mm", "expected three numbers in mm, in the guide frame");
    return;
  }
  for (std::size_t place = 0; place < scene.target_mm.size(); ++place) {
    const auto number = (*position)[place].value<double>();
    if (!number || !std::isfinite(*number) || std::abs(*number) > kDeepest) {
      reader.fail(table, "position_mm", "expected numbers from -1000 to 1000");
      return;
    }
    scene.target_mm[place] = *number;
  }
}

void read_image(Reader& reader, const toml::table& table, SceneParameters& scene) {
  reader.only(table, {"period_s", "age_s", "deviation_mm", "tip_bias_mm", "breathing_mm", "breath_s"});
  reader.number(table, "period_s", {0.01, 100}, scene.image_period_s);
  reader.number(table, "age_s", {0, 100}, scene.image_age_s);
  reader.number(table, "deviation_mm", {0, 10}, scene.image_deviation_mm);
  reader.number(table, "tip_bias_mm", {-50, 50}, scene.image_tip_bias_mm);
  reader.number(table, "breathing_mm", {0, 50}, scene.image_breathing_mm);
  reader.number(table, "breath_s", {0.5, 60}, scene.image_breath_s);
}

}  // namespace

std::optional<SceneParameters> read_scene(Reader& reader, const toml::table& document,
                                          const ilk_config_t& robot, const Parameters& parameters) {
  if (!document.contains("needle")) {
    for (const std::string_view key : kSceneKeys) {
      if (const toml::node* node = document.get(key)) {
        reader.fail(*node, key, "there is no [needle] to work on it");
      }
    }
    return std::nullopt;
  }
  SceneParameters scene;
  read_needle(reader, reader.section(document, "needle"), robot, parameters, scene);
  read_layers(reader, document, scene);
  read_membranes(reader, document, scene);
  read_target(reader, reader.section(document, "target"), scene);
  read_image(reader, reader.section(document, "image"), scene);
  return scene;
}

}  // namespace interlock::plant

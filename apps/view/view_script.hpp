#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace sunfleck::view {

// What a line of a script asks for. kForms in view_script.cpp tells each one's words and parameters.
enum class Verb {
  sun,
  sun_at,
  add_sun,
  sky_image,
  sky,
  ground,
  leaf_albedo,
  leaf_species,
  leaf_prospect,
  leaf_slab,
  leaf_maps_off,
  leaf_maps_albedo,
  leaf_maps_relief,
  leaf_maps,
  leaf_lower_reflectance,
  leaf_lower_gloss,
  leaf_lower_roughness,
  leaf_lower_same,
  leaf,
  gloss,
  model,
  directions,
  map,
  cells,
  samples,
  detail,
  select,
  select_none,
  pick,
  move,
  turn,
  add,
  copy,
  erase,
  paint,
  kind,
  camera_orbit,
  camera_fly,
  camera_walk,
  camera_look,
  camera_zoom,
  camera_pan,
  camera_whole,
  field_of_view,
  camera_save,
  camera_load,
  exposure,
  tone,
  layer,
  compare_off,
  compare_with,
  compare_wipe,
  compare_flip,
  compare_difference,
  probe,
  cost,
  panels,
  tab,
  mouse,
  drag,
  wheel,
  press,
  resize,
  minimise,
  restore,
  frames,
  wait_ready,
  wait_preview,
  wait_reference,
  cancel,
  screenshot,
  window_screenshot,
  exr,
  save,
  undo,
  redo,
  expect_recomputed,
  expect_trees,
  expect_selected,
  expect_same,
  expect_noise,
};

// One line of a script: numbers and texts in the order in which they stand.
struct ScriptStep {
  int line = 0;
  Verb verb{};
  std::vector<double> numbers;
  std::vector<std::string> texts;
};

// One command to a line; words are set apart by spaces, a text with spaces stands in double quotes, and "#" begins a
// comment. Throws InvalidInput("FILE:LINE: WORD: must be RULE") on what is not known, missing, too much or out of its
// range, on more than 1 MB or 100,000 lines.
std::vector<ScriptStep> parseScript(std::string_view text, const std::string& file);
std::vector<ScriptStep> readScript(const std::filesystem::path& file);

// All commands, for people.
std::string scriptHelp();

}  // namespace sunfleck::view

#include "apps/view/view_script.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <sstream>

#include "core/require.hpp"

namespace sunfleck::view {
namespace {

constexpr std::size_t kMostBytes = 1'000'000, kMostLines = 100'000, kLongestQuote = 40;
constexpr double kFar = 1e6;  // [m]

// A word that a command takes.
struct Parameter {
  enum class Kind { number, whole, text, choice };
  const char* name;
  Kind kind = Kind::number;
  double low = 0., high = 0.;
  const char* choices = "";  // of a choice, set apart by "|"
  bool optional = false;     // and all that follow it
};

constexpr Parameter number(const char* name, double low, double high, bool optional = false) {
  return {.name = name, .kind = Parameter::Kind::number, .low = low, .high = high, .optional = optional};
}
constexpr Parameter whole(const char* name, double low, double high, bool optional = false) {
  return {.name = name, .kind = Parameter::Kind::whole, .low = low, .high = high, .optional = optional};
}
constexpr Parameter text(const char* name, bool optional = false) {
  return {.name = name, .kind = Parameter::Kind::text, .optional = optional};
}
constexpr Parameter choice(const char* name, const char* choices, bool optional = false) {
  return {.name = name, .kind = Parameter::Kind::choice, .choices = choices, .optional = optional};
}
constexpr Parameter share(const char* name, bool optional = false) {
  return number(name, 0., 1., optional);
}
constexpr Parameter metres(const char* name, bool optional = false) {
  return number(name, -kFar, kFar, optional);
}
constexpr Parameter degrees(const char* name, double low, double high) {
  return number(name, low, high);
}

struct Form {
  Verb verb;
  const char* words;
  std::vector<Parameter> parameters;
  const char* about;
};

// Where one command's words begin another's, the longer one stands first.
const std::vector<Form>& forms() {
  static const std::vector<Form> kForms{
      {Verb::sun_at,
       "sun at",
       {text("DATE"), text("TIME"), number("LATITUDE", -90., 90.), number("LONGITUDE", -180., 180.)},
       "the sun as it stands on a date (2026-06-21) at a time (12:00, UTC) and a place in degrees"},
      {Verb::add_sun,
       "sun add",
       {degrees("ZENITH", 0., 180.), degrees("AZIMUTH", -360., 360.), number("IRRADIANCE", 0., 10., true)},
       "one more sun, up to 4"},
      {Verb::sun,
       "sun",
       {degrees("ZENITH", 0., 180.), degrees("AZIMUTH", -360., 360.), number("IRRADIANCE", 0., 10., true)},
       "the first sun in degrees, from overhead and from +x towards +y; above 90 it has set"},
      {Verb::sky_image,
       "sky image",
       {text("FILE"), number("ROTATION", -360., 360., true)},
       "a panorama (.hdr, .exr) as the sky; azimuth of its middle column"},
      {Verb::sky,
       "sky",
       {choice("KIND", "none|uniform|overcast|preetham"), number("IRRADIANCE", 0., 1000., true)},
       "the sky and its irradiance of a horizontal plane"},
      {Verb::ground, "ground", {share("ALBEDO"), share("GREEN", true), share("BLUE", true)}, "0: no ground"},
      {Verb::leaf_albedo, "leaf albedo", {share("ALBEDO")}, "half reflected, half let through, of the selected kind"},
      {Verb::leaf_species, "leaf species", {text("NAME")}, "leaves of a measured species; see: sunfleck leaf --list"},
      {Verb::leaf_prospect,
       "leaf prospect",
       {text("CONTENT"), number("VALUE", 0., 1000.)},
       "one content of the leaves' species or contents, or else of PROSPECT's usual leaf; see: sunfleck leaf --help"},
      {Verb::leaf_slab,
       "leaf slab",
       {choice("BAND", "all|red|green|blue"), number("ABSORPTION", 0., 1e6), number("SCATTERING", 0., 1e6),
        number("THICKNESS", 0., 1000.)},
       "leaves as even tissue: 1/mm, 1/mm and mm, the latter of all bands"},
      {Verb::leaf_maps_off,
       "leaf maps off",
       {choice("IMAGE", "upper|upper_gloss|lower|lower_gloss|all")},
       "takes an image of the leaves away, or all that tells their places and sides apart"},
      {Verb::leaf_maps_albedo,
       "leaf maps albedo",
       {number("FACTOR", 0., 100.), number("GREEN", 0., 100., true), number("BLUE", 0., 100., true)},
       "of the reflectance, that a colour of 1 stands for"},
      {Verb::leaf_maps_relief,
       "leaf maps relief",
       {number("MM", 0., 1000.)},
       "what a thickness (alpha) of 1 adds to a slab, and one of 0 takes away"},
      {Verb::leaf_maps,
       "leaf maps",
       {choice("IMAGE", "upper|upper_gloss|lower|lower_gloss"), text("FILE")},
       "an image of the leaves: albedo and thickness, or gloss and its roughness, of a side"},
      {Verb::leaf_lower_same, "leaf lower same", {}, "the lower side is as the upper, without images of its own"},
      {Verb::leaf_lower_reflectance,
       "leaf lower reflectance",
       {share("SHARE"), share("GREEN", true), share("BLUE", true)},
       "of the lower side, by numbers"},
      {Verb::leaf_lower_gloss,
       "leaf lower gloss",
       {share("INTENSITY"), share("GREEN", true), share("BLUE", true)},
       "of the lower side"},
      {Verb::leaf_lower_roughness,
       "leaf lower roughness",
       {number("ROUGHNESS", 0.05, 1.)},
       "of the lower side's gloss"},
      {Verb::leaf,
       "leaf",
       {choice("BAND", "all|red|green|blue"), share("REFLECTANCE"), share("TRANSMITTANCE")},
       "optics of the leaves of the selected tree's kind, or of the first"},
      {Verb::gloss, "gloss", {share("INTENSITY"), number("ROUGHNESS", 0.05, 1., true)}, "of the same leaves"},
      {Verb::model, "model", {text("NAME")}, "ss, spp, sppg and what else --model of render takes"},
      {Verb::directions, "directions", {whole("NUMBER", 2., 200.)}, "sample directions of G, an even number"},
      {Verb::map, "map", {whole("PIXELS", 1., 4096.)}, "along the light's opacity map"},
      {Verb::cells, "cells", {whole("NUMBER", 1., 64.)}, "along the longest side of a tree"},
      {Verb::samples, "samples", {whole("NUMBER", 1., 256.)}, "per pixel, drawn while nothing moves"},
      {Verb::detail, "detail", {choice("LEVEL", "full|fewer")}, "all leaves always, or fewer where they are small"},
      {Verb::select_none, "select none", {}, "no tree"},
      {Verb::select, "select", {whole("TREE", 1., 1e9)}, "a tree by its number"},
      {Verb::pick, "pick", {number("X", -kFar, kFar), number("Y", -kFar, kFar)}, "the tree seen at a pixel, or none"},
      {Verb::move, "move", {metres("X"), metres("Y")}, "the selected tree by so many metres"},
      {Verb::turn, "turn", {degrees("DEGREES", -360., 360.)}, "the selected tree, counter-clockwise from above"},
      {Verb::add, "add", {metres("X"), metres("Y"), text("KIND", true)}, "a tree"},
      {Verb::copy, "copy", {metres("X"), metres("Y")}, "the selected tree, so many metres away"},
      {Verb::erase, "delete", {}, "the selected tree"},
      {Verb::paint,
       "paint",
       {metres("X"), metres("Y"), number("RADIUS", 0., kFar), number("SPACING", 1e-3, kFar)},
       "trees of the selected kind around a place, no nearer to others than the spacing"},
      {Verb::kind, "kind", {text("SPECIES_OR_FILE"), whole("SEED", 1., 2147483647., true)}, "one more kind of tree"},
      {Verb::camera_orbit,
       "camera orbit",
       {degrees("AZIMUTH", -360., 360.), degrees("ELEVATION", -90., 90.)},
       "where the camera stands, seen from its target"},
      {Verb::camera_fly, "camera fly", {metres("RIGHT"), metres("UP"), metres("AHEAD")}, "moves the eye"},
      {Verb::camera_walk, "camera walk", {metres("RIGHT"), metres("AHEAD")}, "moves the eye, 1.7 m above the ground"},
      {Verb::camera_look,
       "camera look",
       {degrees("AZIMUTH", -360., 360.), degrees("ELEVATION", -180., 180.)},
       "turns about the eye by so many degrees"},
      {Verb::camera_zoom, "camera zoom", {number("FACTOR", 1e-3, 1e3)}, "below 1 nearer"},
      {Verb::camera_pan, "camera pan", {number("RIGHT", -kFar, kFar), number("DOWN", -kFar, kFar)}, "in pixels"},
      {Verb::camera_whole, "camera whole", {}, "shows the whole stand"},
      {Verb::camera_save, "camera save", {text("NAME")}, "keeps the camera"},
      {Verb::camera_load, "camera load", {text("NAME")}, "goes to a kept one"},
      {Verb::field_of_view, "field_of_view", {degrees("DEGREES", 0., 150.)}, "of the picture's width, 0: orthographic"},
      {Verb::exposure, "exposure", {number("FACTOR", 1e-6, 1e6)}, "from radiance to brightness"},
      {Verb::tone, "tone", {text("NAME")}, "the curve from brightness to the screen: clamp or filmic"},
      {Verb::layer,
       "layer",
       {text("NAME")},
       "what is shown: total, direct, single, multiple, sky, depth, thickness, g"},
      {Verb::compare_off, "compare off", {}, "the picture alone"},
      {Verb::compare_with, "compare with", {text("MODEL")}, "what B is: a model, or reference (Monte Carlo)"},
      {Verb::compare_wipe, "compare wipe", {share("SHARE")}, "A left of this share of the width, B to the right"},
      {Verb::compare_flip, "compare flip", {}, "B in place of A"},
      {Verb::compare_difference, "compare difference", {number("SCALE", 1e-6, 1e6, true)}, "A - B in false colours"},
      {Verb::probe, "probe", {number("X", -kFar, kFar), number("Y", -kFar, kFar)}, "prints what is at a pixel"},
      {Verb::cost, "cost", {}, "prints what the last change computed anew, and what that took"},
      {Verb::panels, "panels", {choice("SHOWN", "on|off")}, "beside the picture"},
      {Verb::tab, "tab", {text("NAME")}, "shows a panel: scene, light, leaf, model, compare, probe, times, files"},
      {Verb::mouse, "mouse", {number("X", -kFar, kFar), number("Y", -kFar, kFar)}, "moves the mouse in the window"},
      {Verb::drag,
       "drag",
       {number("X", -kFar, kFar), number("Y", -kFar, kFar), number("TO_X", -kFar, kFar), number("TO_Y", -kFar, kFar),
        choice("BUTTON", "left|right|middle", true)},
       "with the mouse, from a pixel of the window to another"},
      {Verb::wheel, "wheel", {number("STEPS", -100., 100.)}, "of the mouse"},
      {Verb::press, "press", {text("KEY")}, "a key: a letter, or delete, space, escape, tab, enter"},
      {Verb::resize, "resize", {whole("WIDTH", 1., 16384.), whole("HEIGHT", 1., 16384.)}, "the window, in pixels"},
      {Verb::minimise, "minimise", {}, "the window"},
      {Verb::restore, "restore", {}, "the window"},
      {Verb::frames, "frames", {whole("NUMBER", 1., 1e6)}, "draws so many"},
      {Verb::wait_ready, "wait ready", {}, "until all is computed and the picture is smooth"},
      {Verb::wait_preview, "wait preview", {}, "until the light field is seen, if only its preview on cells"},
      {Verb::wait_reference,
       "wait reference",
       {number("NOISE", 1e-4, 1.)},
       "until Monte Carlo has at most this relative noise"},
      {Verb::cancel, "cancel", {}, "what is computed in the background"},
      {Verb::window_screenshot, "screenshot window", {text("FILE")}, "the window with its panels, .png"},
      {Verb::screenshot, "screenshot", {text("FILE")}, "the picture as shown, .png"},
      {Verb::exr, "exr", {text("FILE")}, "radiances in layers, .exr"},
      {Verb::save, "save", {text("FILE")}, "the scene, .toml"},
      {Verb::undo, "undo", {whole("STEPS", 1., 1e6, true)}, ""},
      {Verb::redo, "redo", {whole("STEPS", 1., 1e6, true)}, ""},
      {Verb::expect_recomputed,
       "expect recomputed",
       {text("PRODUCT"), whole("NUMBER", 0., 1e9, true)},
       "since the last such line: a product (with _ for spaces), or none at all"},
      {Verb::expect_trees, "expect trees", {whole("NUMBER", 0., 1e9)}, "stand in the scene"},
      {Verb::expect_selected, "expect selected", {whole("TREE", 0., 1e9)}, "this tree, or 0 for none"},
      {Verb::expect_same, "expect same", {text("FILE"), text("FILE")}, "two files of the same bytes"},
      {Verb::expect_noise, "expect noise", {number("NOISE", 0., 1e6)}, "of the reference, at most"},
  };
  return kForms;
}

std::string inQuotes(std::string_view word) {
  return fmt::format("\"{}{}\"", word.substr(0, kLongestQuote), word.size() > kLongestQuote ? "..." : "");
}

struct Place {
  const std::string& file;
  int line;
  [[noreturn]] void wrong(const std::string& what) const {
    throw InvalidInput(fmt::format("{}:{}: {}", file, line, what));
  }
};

std::vector<std::string> wordsOf(std::string_view line, const Place& place) {
  std::vector<std::string> words;
  const auto blank = [](char c) { return c == ' ' || c == '\t' || c == '\r'; };
  for (std::size_t i = 0; i < line.size();) {
    if (blank(line[i])) {
      ++i;
    } else if (line[i] == '#') {
      break;
    } else if (line[i] == '"') {
      const std::size_t end = line.find('"', i + 1);
      if (end == std::string_view::npos) place.wrong(inQuotes(line.substr(i)) + ": must end with a quote");
      words.emplace_back(line.substr(i + 1, end - i - 1));
      i = end + 1;
    } else {
      const std::size_t start = i;
      while (i < line.size() && !blank(line[i])) ++i;
      words.emplace_back(line.substr(start, i - start));
    }
  }
  return words;
}

std::vector<std::string> split(std::string_view text, char by) {
  std::vector<std::string> parts;
  std::istringstream in{std::string(text)};
  for (std::string part; std::getline(in, part, by);) parts.push_back(part);
  return parts;
}

std::string ruleOf(const Parameter& p) {
  switch (p.kind) {
    case Parameter::Kind::number:
      return fmt::format("in [{:g}, {:g}]", p.low, p.high);
    case Parameter::Kind::whole:
      return fmt::format("a whole number, {:.0f} to {:.0f}", p.low, p.high);
    case Parameter::Kind::choice:
      return fmt::format("one of {}", fmt::join(split(p.choices, '|'), ", "));
    case Parameter::Kind::text:
      break;
  }
  return "1 to 4096 characters";
}

void take(ScriptStep& step, const Parameter& p, const std::string& word, const Place& place, const char* command) {
  const auto refuse = [&] {
    place.wrong(fmt::format("{} {} = {}: must be {}", command, p.name, inQuotes(word), ruleOf(p)));
  };
  if (p.kind == Parameter::Kind::text) {
    constexpr std::size_t kLongest = 4096;
    if (word.empty() || word.size() > kLongest) refuse();
    step.texts.push_back(word);
    return;
  }
  if (p.kind == Parameter::Kind::choice) {
    const std::vector<std::string> choices = split(p.choices, '|');
    if (std::ranges::find(choices, word) == choices.end()) refuse();
    step.texts.push_back(word);
    return;
  }
  double value = 0.;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  const bool is_number = error == std::errc{} && end == word.data() + word.size() && std::isfinite(value);
  if (!is_number || value < p.low || value > p.high) refuse();
  if (p.kind == Parameter::Kind::whole && value != std::floor(value)) refuse();
  step.numbers.push_back(value);
}

// The form whose words these begin with, and how many they are.
std::pair<const Form*, std::size_t> formOf(const std::vector<std::string>& words) {
  for (const Form& form : forms()) {
    const std::vector<std::string> own = split(form.words, ' ');
    if (own.size() <= words.size() && std::equal(own.begin(), own.end(), words.begin())) return {&form, own.size()};
  }
  return {nullptr, 0};
}

ScriptStep stepOf(const std::vector<std::string>& words, const Place& place) {
  const auto [form, used] = formOf(words);
  if (!form) {
    std::vector<std::string> further;
    for (const Form& other : forms())
      if (const auto own = split(other.words, ' '); own.size() > 1 && own[0] == words[0]) further.push_back(own[1]);
    if (further.empty())
      place.wrong(fmt::format("{}: must be a command; see: sunfleck view --help", inQuotes(words[0])));
    place.wrong(fmt::format("{} {}: must be one of {}", words[0],
                            words.size() > 1 ? inQuotes(words[1]) : "without a word", fmt::join(further, ", ")));
  }
  ScriptStep step{.line = place.line, .verb = form->verb, .numbers = {}, .texts = {}};
  std::size_t next = used;
  for (const Parameter& p : form->parameters) {
    if (next == words.size()) {
      if (p.optional) break;
      place.wrong(fmt::format("{}: has no {}: must be {}", form->words, p.name, ruleOf(p)));
    }
    take(step, p, words[next++], place, form->words);
  }
  if (next < words.size())
    place.wrong(fmt::format("{} {}: must be no word too many", form->words, inQuotes(words[next])));
  return step;
}

}  // namespace

std::vector<ScriptStep> parseScript(std::string_view text, const std::string& file) {
  require(text.size() <= kMostBytes, file + ": size [byte]", text.size(), "at most 1000000");
  std::vector<ScriptStep> steps;
  std::size_t line_number = 0;
  for (std::size_t start = 0; start < text.size();) {
    const std::size_t end = std::min(text.find('\n', start), text.size());
    require(++line_number <= kMostLines, file + ": number of lines", line_number, "at most 100000");
    const Place place{file, static_cast<int>(line_number)};
    if (const auto words = wordsOf(text.substr(start, end - start), place); !words.empty())
      steps.push_back(stepOf(words, place));
    start = end + 1;
  }
  return steps;
}

std::vector<ScriptStep> readScript(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  if (!in || std::filesystem::is_directory(file))
    throw InvalidInput(file.string() + ": cannot be read: must be a script");
  std::string text(kMostBytes + 1, '\0');  // an endless file ends here, and is too large
  in.read(text.data(), static_cast<std::streamsize>(text.size()));
  text.resize(static_cast<std::size_t>(in.gcount()));
  return parseScript(text, file.string());
}

std::string scriptHelp() {
  std::string help;
  for (const Form& form : forms()) {
    std::string line = form.words;
    for (const Parameter& p : form.parameters) {
      const std::string name = p.kind == Parameter::Kind::choice ? p.choices : p.name;
      line += p.optional ? " [" + name + "]" : " " + name;
    }
    help += *form.about ? fmt::format("  {:<44} {}\n", line, form.about) : fmt::format("  {}\n", line);
  }
  return help;
}

}  // namespace sunfleck::view

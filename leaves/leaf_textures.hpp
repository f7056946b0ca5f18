#pragma once

#include <array>
#include <filesystem>
#include <glm/vec3.hpp>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/leaf_maps.hpp"
#include "core/leaf_optics.hpp"
#include "leaves/leaf_description.hpp"

namespace sunfleck {

// One image of a leaf: linear values as they stand in the file, rows from top to bottom.
struct LeafTexture {
  std::filesystem::path file;     // that it was read from; empty: made by a program
  int width = 1, height = 1;      // [place], 1 .. kMostMapWidth
  std::vector<glm::vec3> colour;  // per band, of each place
  std::vector<float> alpha;       // as many [1], 0 .. 1; or none
};

// Throws InvalidInput("<what>: ...") where a size or a value is out of its range. `most_colour`: of the colours.
void validate(const LeafTexture& texture, float most_colour, const std::string& what);
inline constexpr float kMostLeafAlbedo = 100.f;  // of gamma

// What the images tell of one side. One that is not there says nothing.
struct LeafSideTextures {
  std::shared_ptr<const LeafTexture> detail;  // colour: gamma over LeafTextures::albedo, alpha: thickness
  std::shared_ptr<const LeafTexture> gloss;   // colour: rho_s [1], 0 .. 1; alpha: m [1], below 0.05 as 0.05
  bool any() const { return detail || gloss; }
  bool operator==(const LeafSideTextures&) const = default;  // the same images, not equal ones
};

// What is different on the lower side, by numbers; what is not told is as on the upper side.
struct LeafUnderside {
  std::optional<glm::vec3> reflectance;  // per band [1], 0 .. 1, at most what is not let through
  std::optional<glm::vec3> gloss;        // rho_s per band [1], 0 .. 1
  std::optional<float> gloss_roughness;  // m [1], 0.05 .. 1
  bool any() const { return reflectance || gloss || gloss_roughness; }
  bool operator==(const LeafUnderside&) const = default;
};

// What tells the places and the sides of a leaf apart; left as it is, nothing: they are alike.
struct LeafTextures {
  // Of one size, all of them. A lower side without an image of its own shows the upper's.
  LeafSideTextures upper, lower;
  LeafUnderside underside;  // not beside lower images
  glm::vec3 albedo{1.f};    // gamma that a colour of 1 stands for, per band [1], 0 .. kMostLeafAlbedo
  double relief = 0.1;      // delta = (2 alpha - 1) relief [mm], 0 .. 1000

  bool any() const { return upper.any() || lower.any() || underside.any(); }
  bool operator==(const LeafTextures&) const = default;
};

// Throws InvalidInput("<what>: ...") on images of different sizes, lower images beside an underside by numbers, and
// numbers out of their ranges.
void validate(const LeafTextures& textures, const std::string& what);

// (L11) What every place of a leaf and each side of it does to light, none where the textures tell nothing apart:
// gamma R and T, of tissue at the thickness h + delta of the place, of other leaves those of `even`, where delta counts
// for nothing. delta is the mean of both sides' images, as what is let through is the same from both sides. Where
// gamma R + T would be more than 1, the place absorbs nothing. Roughnesses are rounded to the nearest of eight.
//   even      bandOptics() of the leaf, with its gloss
//   textures  whose images passed validate()
// Throws as validate() does. The same to the bit for any number of threads. Some 20 ms for 720 x 540.
std::shared_ptr<const LeafMaps> leafMaps(const LeafDescription& leaf, const BandOptics& even,
                                         const LeafTextures& textures);

}  // namespace sunfleck

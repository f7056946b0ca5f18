#include "leaves/leaf_textures.hpp"

#include <fmt/format.h>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "core/require.hpp"
#include "leaves/tissue_by_thickness.hpp"

namespace sunfleck {
namespace {

std::vector<const LeafTexture*> imagesOf(const LeafTextures& textures) {
  std::vector<const LeafTexture*> images;
  for (const LeafSideTextures* side : {&textures.upper, &textures.lower})
    for (const auto& image : {side->detail, side->gloss})
      if (image) images.push_back(image.get());
  return images;
}

// Roughnesses of places, rounded to a few.
class RoughnessLevels {
 public:
  void count(float roughness) {
    Bin& bin = bins_[binOf(roughness)];
    ++bin.places;
    bin.least = std::min(bin.least, clamped(roughness));
  }

  // The levels nearest to what was counted, by Lloyd's method from even shares of the places.
  std::vector<float> settle() {
    std::vector<std::size_t> held;
    std::uint64_t all = 0;
    for (std::size_t i = 0; i < kBins; ++i)
      if (bins_[i].places > 0) {
        held.push_back(i);
        all += bins_[i].places;
      }
    if (held.empty()) return {LeafMaps{}.roughnesses};
    std::vector<double> levels;
    if (held.size() <= kMostRoughnesses) {
      for (const std::size_t i : held) levels.push_back(double{bins_[i].least});
    } else {
      std::uint64_t before = 0;
      for (const std::size_t i : held) {
        before += bins_[i].places;
        if (before * kMostRoughnesses >= all * (levels.size() + 1)) levels.push_back(double{bins_[i].least});
        if (levels.size() == kMostRoughnesses) break;
      }
      constexpr int kRounds = 30;
      for (int round = 0; round < kRounds; ++round) {
        std::vector<double> sums(levels.size(), 0.), places(levels.size(), 0.);
        for (const std::size_t i : held) {
          const std::size_t level = nearest(levels, double{bins_[i].least});
          sums[level] += static_cast<double>(bins_[i].places) * double{bins_[i].least};
          places[level] += static_cast<double>(bins_[i].places);
        }
        for (std::size_t level = 0; level < levels.size(); ++level)
          if (places[level] > 0.) levels[level] = sums[level] / places[level];
      }
    }
    for (std::size_t i = 0; i < kBins; ++i)
      level_of_bin_[i] =
          static_cast<std::uint32_t>(nearest(levels, bins_[i].places > 0 ? double{bins_[i].least} : middleOf(i)));
    std::vector<float> values;
    for (const double level : levels) values.push_back(clamped(static_cast<float>(level)));
    return values;
  }

  std::uint32_t levelOf(float roughness) const { return level_of_bin_[binOf(roughness)]; }

 private:
  // Finer than the steps of images of 8 bits.
  static constexpr std::size_t kBins = 256;
  struct Bin {
    std::uint64_t places = 0;
    float least = 1.f;
  };
  static float clamped(float roughness) { return std::clamp(roughness, kLeastGlossRoughness, 1.f); }
  static std::size_t binOf(float roughness) {
    return static_cast<std::size_t>((clamped(roughness) - kLeastGlossRoughness) / (1.f - kLeastGlossRoughness) *
                                    (static_cast<float>(kBins) - 0.5f));
  }
  static double middleOf(std::size_t bin) {
    return double{kLeastGlossRoughness} +
           (static_cast<double>(bin) + 0.5) / (static_cast<double>(kBins) - 0.5) * (1. - double{kLeastGlossRoughness});
  }
  static std::size_t nearest(const std::vector<double>& levels, double roughness) {
    return static_cast<std::size_t>(
        std::ranges::min_element(levels, {}, [&](double level) { return std::abs(level - roughness); }) -
        levels.begin());
  }

  std::array<Bin, kBins> bins_{};
  std::array<std::uint32_t, kBins> level_of_bin_{};
};

// One side of the leaf: what its images tell and, where they tell nothing, the numbers that hold everywhere.
struct Side {
  const LeafTexture* detail = nullptr;     // none: gamma is 1
  const LeafTexture* gloss = nullptr;      // of which the colour is taken
  const LeafTexture* roughness = nullptr;  // of which alpha is taken
  std::optional<glm::vec3> reflectance;    // whatever gamma is
  glm::vec3 even_gloss{0.f};
  float even_roughness = 0.f;

  float roughnessAt(std::size_t place) const { return roughness ? roughness->alpha[place] : even_roughness; }
  glm::vec3 glossAt(std::size_t place) const { return gloss ? gloss->colour[place] : even_gloss; }
};

const LeafTexture* withAlpha(const LeafTexture* texture) {
  return texture && !texture->alpha.empty() ? texture : nullptr;
}

std::array<Side, 2> sidesOf(const LeafTextures& textures, const BandOptics& even) {
  Side upper{.detail = textures.upper.detail.get(),
             .gloss = textures.upper.gloss.get(),
             .roughness = withAlpha(textures.upper.gloss.get()),
             .even_roughness = even[0].gloss_roughness};
  for (int band = 0; band < kBands; ++band) upper.even_gloss[band] = even[static_cast<std::size_t>(band)].gloss;
  Side lower = upper;
  if (textures.lower.detail) lower.detail = textures.lower.detail.get();
  if (textures.lower.gloss) {
    lower.gloss = textures.lower.gloss.get();
    lower.roughness = withAlpha(lower.gloss);
  }
  lower.reflectance = textures.underside.reflectance;
  if (textures.underside.gloss) {
    lower.gloss = nullptr;
    lower.even_gloss = *textures.underside.gloss;
  }
  if (textures.underside.gloss_roughness) {
    lower.roughness = nullptr;
    lower.even_roughness = *textures.underside.gloss_roughness;
  }
  return {upper, lower};
}

// Reflectance and transmittance at each place where gamma is 1.
class Inside {
 public:
  Inside(const LeafDescription& leaf, const BandOptics& even, const LeafTextures& textures) : relief_(textures.relief) {
    for (std::size_t band = 0; band < kBands; ++band) {
      even_.reflectance[band] = double{even[band].reflectance};
      even_.transmittance[band] = double{even[band].transmittance};
    }
    const auto* tissue = std::get_if<LeafByTissue>(&leaf);
    if (!tissue || relief_ == 0.) return;
    for (const LeafSideTextures* side : {&textures.upper, &textures.lower})
      if (const LeafTexture* thickness = withAlpha(side->detail.get())) thickness_.push_back(thickness);
    if (thickness_.empty()) return;
    thickness_of_leaf_ = tissue->thickness;
    tissue_.emplace(glm::dvec3(tissue->absorption), glm::dvec3(tissue->scattering),
                    std::max(tissue->thickness - relief_, 0.), tissue->thickness + relief_);
  }

  TissueBands at(std::size_t place) const {
    if (!tissue_) return even_;
    double alpha = 0.;
    for (const LeafTexture* texture : thickness_) alpha += double{texture->alpha[place]};
    const double delta = (2. * alpha / static_cast<double>(thickness_.size()) - 1.) * relief_;
    return tissue_->at(thickness_of_leaf_ + delta);
  }

 private:
  TissueBands even_;
  double relief_ = 0., thickness_of_leaf_ = 0.;  // [mm]
  std::vector<const LeafTexture*> thickness_;
  std::optional<TissueByThickness> tissue_;
};

LeafPlace placeOf(const TissueBands& inside, const std::array<Side, 2>& sides, const glm::vec3& albedo,
                  const RoughnessLevels& levels, std::size_t place) {
  LeafPlace of;
  for (int band = 0; band < kBands; ++band)
    of.transmittance[band] = static_cast<float>(inside.transmittance[static_cast<std::size_t>(band)]);
  for (std::size_t side = 0; side < 2; ++side) {
    const Side& from = sides[side];
    LeafFace& face = of.faces[side];
    for (int band = 0; band < kBands; ++band) {
      const auto even = static_cast<float>(inside.reflectance[static_cast<std::size_t>(band)]);
      const float gamma = from.detail ? albedo[band] * from.detail->colour[place][band] : 1.f;
      const float reflectance = from.reflectance ? (*from.reflectance)[band] : gamma * even;
      face.reflectance[band] = std::min(reflectance, 1.f - of.transmittance[band]);
    }
    face.gloss = from.glossAt(place);
    face.roughness = levels.levelOf(from.roughnessAt(place));
  }
  return of;
}

void requireShares(const glm::vec3& shares, const std::string& what) {
  for (int band = 0; band < kBands; ++band)
    require(shares[band] >= 0.f && shares[band] <= 1.f, what, shares[band], "in [0, 1]");
}

}  // namespace

void validate(const LeafTexture& texture, float most_colour, const std::string& what) {
  for (const int side : {texture.width, texture.height})
    require(side >= 1 && side <= kMostMapWidth, what + ": width or height", side, "1 to 4096 pixels");
  const std::size_t places = static_cast<std::size_t>(texture.width) * static_cast<std::size_t>(texture.height);
  require(texture.colour.size() == places, what + ": number of colours", texture.colour.size(), "width times height");
  require(texture.alpha.empty() || texture.alpha.size() == places, what + ": number of alphas", texture.alpha.size(),
          "width times height");
  const std::string most = fmt::format("in [0, {}]", most_colour);
  for (const glm::vec3& colour : texture.colour)
    for (int band = 0; band < kBands; ++band)
      require(colour[band] >= 0.f && colour[band] <= most_colour, what + ": a value", colour[band], most);
  for (const float alpha : texture.alpha)
    require(alpha >= 0.f && alpha <= 1.f, what + ": an alpha", alpha, "in [0, 1]");
}

void validate(const LeafTextures& textures, const std::string& what) {
  const std::vector<const LeafTexture*> images = imagesOf(textures);
  for (const LeafTexture* image : images)
    if (image->width != images[0]->width || image->height != images[0]->height)
      throw InvalidInput(fmt::format("{}: {} has {} x {} pixels and {} has {} x {}: must be of one size", what,
                                     images[0]->file.string(), images[0]->width, images[0]->height,
                                     image->file.string(), image->width, image->height));
  if (textures.underside.any() && textures.lower.any())
    throw InvalidInput(what + ": has both lower images and a lower side by numbers: must be one of them");
  for (int band = 0; band < kBands; ++band)
    require(textures.albedo[band] >= 0.f && textures.albedo[band] <= kMostLeafAlbedo, what + ": albedo",
            textures.albedo[band], "in [0, 100]");
  require(textures.relief >= 0. && textures.relief <= 1000., what + ": relief", textures.relief, "in [0, 1000] mm");
  if (textures.underside.reflectance) requireShares(*textures.underside.reflectance, what + ": lower reflectance");
  if (textures.underside.gloss) requireShares(*textures.underside.gloss, what + ": lower gloss");
  if (const std::optional<float> rough = textures.underside.gloss_roughness)
    require(*rough >= kLeastGlossRoughness && *rough <= 1.f, what + ": lower gloss_roughness", *rough, "in [0.05, 1]");
}

std::shared_ptr<const LeafMaps> leafMaps(const LeafDescription& leaf, const BandOptics& even,
                                         const LeafTextures& textures) {
  if (!textures.any()) return nullptr;
  validate(textures, "leaf");
  const std::vector<const LeafTexture*> images = imagesOf(textures);
  const std::array<Side, 2> sides = sidesOf(textures, even);
  auto maps = std::make_shared<LeafMaps>();
  if (!images.empty()) {
    maps->width = images[0]->width;
    maps->height = images[0]->height;
  }
  const std::size_t places = static_cast<std::size_t>(maps->width) * static_cast<std::size_t>(maps->height);
  RoughnessLevels levels;
  for (const Side& side : sides) {
    if (!side.roughness) {
      levels.count(side.even_roughness);
      continue;
    }
    for (std::size_t place = 0; place < places; ++place)  // where nothing is glossy, how rough it is does not matter
      if (side.glossAt(place) != glm::vec3(0.f)) levels.count(side.roughnessAt(place));
  }
  maps->roughnesses = levels.settle();
  const Inside inside(leaf, even, textures);
  maps->places.resize(places);
  constexpr std::size_t kGrain = 2048;
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, places, kGrain), [&](const auto& range) {
    for (std::size_t place = range.begin(); place != range.end(); ++place)
      maps->places[place] = placeOf(inside.at(place), sides, textures.albedo, levels, place);
  });
  return maps;
}

}  // namespace sunfleck

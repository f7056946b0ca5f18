#include "scattering/gloss_tables.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <numbers>

#include "scattering/detail/gloss_text.hpp"
#include "scattering/leaf_gloss.hpp"

namespace sunfleck {
namespace {

using namespace gloss;
static_assert(kGlossTableNumbers == kGlossNumbers);
static_assert(kGlossSlantsFirst == kGlossAlbedos + 1 && kGlossSharesFirst == kGlossSlantsFirst + kGlossSlants + 1);
static_assert(kGlossMeanAlbedo == kGlossSlantsFirst + kGlossSlants);
static_assert(kGlossNumbers == kGlossSharesFirst + kGlossViews * kGlossHeights * kGlossTurns);

// Share of the directions of one cosine to the leaf's normal that lie in the half about a normal of another.
double shareOfTurn(double cosine, double slant) {
  const double sines = std::sqrt((1. - cosine * cosine) * (1. - slant * slant)), product = cosine * slant;
  if (std::abs(product) >= sines) return product > 0. ? 1. : 0.;
  return 1. - std::acos(product / sines) * std::numbers::inv_pi;
}

// A = 1 / pi integral of E mu' over the directions of the leaf's side in the slab's upper half.
double slantedAlbedo(const LeafGloss& gloss, double slant) {
  constexpr int kSteps = 512;
  double sum = 0.;
  for (int i = 0; i < kSteps; ++i) {
    const double cosine = (i + 0.5) / kSteps;
    sum += double{gloss.albedo(static_cast<float>(cosine))} * cosine * shareOfTurn(cosine, slant);
  }
  return 2. * sum / kSteps;
}

struct Reflected {
  glm::vec3 to_light;  // the eye is at (sine, 0, cosine)
  float weight;        // f mu' times its solid angle, to a common factor
  float width;         // by which a step of the slopes turns it, as a cosine to a direction across
};

// Over the slopes of the facets, as LeafGloss has its albedo.
constexpr float kWidest = 3.5f, kStep = 1.f / 12.f;
std::vector<Reflected> reflectedLight(const LeafGloss& gloss, float roughness, float cosine) {
  const glm::vec3 eye(std::sqrt((1.f - cosine) * (1.f + cosine)), 0.f, cosine);
  std::vector<Reflected> reflected;
  for (float p = -kWidest + 0.5f * kStep; p < kWidest; p += kStep)
    for (float q = 0.5f * kStep; q < kWidest; q += kStep) {
      const glm::vec3 facet = glm::normalize(glm::vec3(-roughness * p, -roughness * q, 1.f));
      const float facing = glm::dot(facet, eye);
      if (!(facing > 0.f)) continue;
      const glm::vec3 light = 2.f * facing * facet - eye;
      if (!(light.z > 0.f)) continue;
      // f mu' dl with dl = 4 facing dfacet, dfacet = cos^3 dslope.
      const float weight = gloss.brdf(eye, light) * light.z * facing * facet.z * facet.z * facet.z;
      reflected.push_back({light, weight, 2.f * roughness * kStep * facet.z});
    }
  return reflected;
}

// The share of reflected light that comes from the half about `up`; both signs of y count.
float shareFrom(const std::vector<Reflected>& reflected, const glm::vec3& up) {
  double all = 0., upper = 0.;
  for (const Reflected& light : reflected)
    for (const float y : {up.y, -up.y}) {
      const float above = light.to_light.x * up.x + light.to_light.y * y + light.to_light.z * up.z;
      all += double{light.weight};
      upper += double{light.weight * std::clamp(0.5f + above / light.width, 0.f, 1.f)};
    }
  return all > 0. ? static_cast<float>(upper / all) : 0.5f;
}

}  // namespace

std::vector<float> glossTables(float roughness) {
  const LeafGloss gloss(roughness);
  std::vector<float> numbers;
  numbers.reserve(kGlossNumbers);
  for (int i = 0; i <= kGlossAlbedos; ++i) {
    const float root = static_cast<float>(i) / static_cast<float>(kGlossAlbedos);
    numbers.push_back(gloss.albedo(root * root));
  }
  for (int i = 0; i <= kGlossSlants; ++i) {
    // Both halves together give the mean albedo exactly, so that no light is lost between them.
    const double slant = 2. * i / kGlossSlants - 1., mean = double{gloss.meanAlbedo()};
    const double upper = slantedAlbedo(gloss, slant), lower = slantedAlbedo(gloss, -slant);
    numbers.push_back(static_cast<float>(mean * upper / (upper + lower)));
  }
  const float narrow = 2.f * roughness;
  for (int view = 0; view < kGlossViews; ++view) {
    const float t = static_cast<float>(view) / static_cast<float>(kGlossViews - 1), rest = 1.f - t;
    const float eye = std::max(t * t / (t * t + rest * rest), 1e-4f), sine = std::sqrt((1.f - eye) * (1.f + eye));
    const std::vector<Reflected> reflected = reflectedLight(gloss, roughness, eye);
    const glm::vec3 mirrored(-sine, 0.f, eye), towards_normal(eye, 0.f, sine);
    for (int height = 0; height < kGlossHeights; ++height) {
      const float at = 2.f * static_cast<float>(height) / static_cast<float>(kGlossHeights - 1) - 1.f;
      const float h = std::clamp(at * narrow / (1.f + narrow - std::abs(at)), -1.f, 1.f);
      for (int turn = 0; turn < kGlossTurns; ++turn) {
        const float c = 2.f * static_cast<float>(turn) / static_cast<float>(kGlossTurns - 1) - 1.f;
        const float s = std::sqrt(std::max(0.f, 1.f - c * c)), across = std::sqrt(std::max(0.f, 1.f - h * h));
        const glm::vec3 up = h * mirrored + across * (c * towards_normal + s * glm::vec3(0.f, 1.f, 0.f));
        numbers.push_back(shareFrom(reflected, up));
      }
    }
  }
  return numbers;
}

}  // namespace sunfleck

#include "plants/leaf_shape.hpp"

#include <array>

namespace sunfleck {
namespace {

using P = glm::dvec2;

// Drawn by us after leaves.
constexpr std::array kRectangle{P{0., 0.}, P{1., 0.}, P{1., 1.}, P{0., 1.}};
constexpr std::array kElliptic{P{0., 0.}, P{0.6, 0.1}, P{0.92, 0.3}, P{1., 0.5}, P{0.92, 0.7}, P{0.6, 0.9}, P{0., 1.}};
constexpr std::array kOvate{P{0., 0.},     P{0.55, 0.05}, P{0.92, 0.18}, P{1., 0.33},
                            P{0.85, 0.55}, P{0.5, 0.78},  P{0.18, 0.93}, P{0., 1.}};
constexpr std::array kLinear{P{0., 0.}, P{0.6, 0.12}, P{1., 0.35}, P{0.9, 0.6}, P{0.45, 0.85}, P{0., 1.}};
constexpr std::array kNeedle{P{0., 0.}, P{1., 0.06}, P{1., 0.8}, P{0., 1.}};
constexpr std::array kCordate{P{0., 0.},    P{0.4, -0.1}, P{0.82, -0.04}, P{1., 0.16}, P{0.94, 0.36},
                              P{0.68, 0.6}, P{0.33, 0.8}, P{0.1, 0.93},   P{0., 1.}};
constexpr std::array kDeltoid{P{0., 0.},     P{0.6, 0.03},  P{1., 0.2}, P{0.8, 0.45},
                              P{0.42, 0.73}, P{0.13, 0.92}, P{0., 1.}};
constexpr std::array kMaple{P{0., 0.},     P{0.3, -0.08}, P{0.78, -0.03}, P{0.6, 0.12},  P{0.62, 0.22},
                            P{0.85, 0.26}, P{1., 0.46},   P{0.78, 0.47},  P{0.68, 0.58}, P{0.3, 0.5},
                            P{0.38, 0.72}, P{0.18, 0.78}, P{0., 1.}};
constexpr std::array kPalmate{P{0., 0.},       P{0.232, -0.004}, P{0.432, -0.059}, P{0.298, 0.048}, P{0.261, 0.097},
                              P{0.616, 0.103}, P{1., 0.172},     P{0.609, 0.223},  P{0.327, 0.236}, P{0.656, 0.434},
                              P{0.929, 0.706}, P{0.482, 0.546},  P{0.158, 0.38},   P{0.133, 0.671}, P{0., 1.}};
constexpr std::array kRoundedOak{P{0., 0.},     P{0.22, 0.07}, P{0.18, 0.15}, P{0.55, 0.22}, P{0.6, 0.28},
                                 P{0.36, 0.34}, P{0.8, 0.42},  P{0.84, 0.5},  P{0.5, 0.56},  P{0.98, 0.66},
                                 P{1., 0.74},   P{0.66, 0.79}, P{0.62, 0.9},  P{0.3, 0.98},  P{0., 1.}};
constexpr std::array kSpikyOak{P{0., 0.},      P{0.105, 0.1},  P{0.526, 0.16}, P{0.653, 0.27}, P{0.168, 0.3},
                               P{0.758, 0.42}, P{1., 0.58},    P{0.253, 0.56}, P{0.863, 0.78}, P{0.632, 0.84},
                               P{0.274, 0.78}, P{0.253, 0.92}, P{0., 1.}};
constexpr std::array kBlossom{P{0., 0.},       P{0.214, -0.296}, P{0.618, -0.292}, P{0.749, -0.032},
                              P{0.4, 0.197},   P{0.881, 0.244},  P{1., 0.506},     P{0.677, 0.671},
                              P{0.247, 0.517}, P{0.331, 0.842},  P{0., 1.}};

struct Shape {
  LeafShape shape;
  std::string_view name;
  std::span<const P> half;
};
constexpr std::array kShapes{Shape{LeafShape::rectangle, "rectangle", kRectangle},
                             Shape{LeafShape::elliptic, "elliptic", kElliptic},
                             Shape{LeafShape::ovate, "ovate", kOvate},
                             Shape{LeafShape::linear, "linear", kLinear},
                             Shape{LeafShape::needle, "needle", kNeedle},
                             Shape{LeafShape::cordate, "cordate", kCordate},
                             Shape{LeafShape::deltoid, "deltoid", kDeltoid},
                             Shape{LeafShape::maple, "maple", kMaple},
                             Shape{LeafShape::palmate, "palmate", kPalmate},
                             Shape{LeafShape::rounded_oak, "rounded_oak", kRoundedOak},
                             Shape{LeafShape::spiky_oak, "spiky_oak", kSpikyOak},
                             Shape{LeafShape::blossom, "blossom", kBlossom}};

const Shape& entry(LeafShape shape) {
  return kShapes[static_cast<std::size_t>(shape)];
}

}  // namespace

std::span<const glm::dvec2> halfOutline(LeafShape shape) {
  return entry(shape).half;
}

// Twice the half's area, by the shoelace formula, over a width of 2.
double areaShare(LeafShape shape) {
  const std::span<const P> half = halfOutline(shape);
  double area = 0.;
  for (std::size_t i = 0; i + 1 < half.size(); ++i)
    area += 0.5 * (half[i].x * half[i + 1].y - half[i + 1].x * half[i].y);
  return area;
}

std::string_view nameOf(LeafShape shape) {
  return entry(shape).name;
}

std::vector<LeafShape> leafShapes() {
  std::vector<LeafShape> all;
  for (const Shape& shape : kShapes) all.push_back(shape.shape);
  return all;
}

}  // namespace sunfleck

#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace sunfleck {

// (F18) Anderson's acceleration of a fixed point x = g(x) (Walker & Ni 2011): the next x is the one whose residual
// would be least if g were linear in the last few steps. For linear g it is as good as GMRES on so many steps.
class Anderson {
 public:
  //   weights  of the squares of each entry's residual [>= 0]
  Anderson(std::size_t depth, std::vector<float> weights);

  // Turns x into the next one.
  //   g  g(x)
  void next(std::span<float> x, std::span<const float> g);

 private:
  // Sums over the weighted products of a residual with what is kept, in parts that do not depend on threads.
  struct Step {
    std::vector<float> residual, value;  // differences to those of the step before
  };
  template <typename Terms>
  std::vector<double> sums(std::size_t count, const Terms& terms) const;

  std::size_t depth_;
  std::vector<float> weights_, last_residual_, last_value_;
  std::vector<Step> steps_;                // the newest last
  std::vector<std::vector<double>> gram_;  // products of their residuals
};

}  // namespace sunfleck

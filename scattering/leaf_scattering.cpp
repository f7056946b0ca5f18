#include "scattering/leaf_scattering.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <numbers>

#include "core/require.hpp"

namespace sunfleck {
namespace {

constexpr double kPi = std::numbers::pi;

double sineOf(double mu) {
  return std::sqrt(std::max(0., (1. - mu) * (1. + mu)));
}

// |n . s|(phi) = |flat + round cos phi|, flat = cos theta_L mu, round = sin theta_L sin theta. Where round > flat the
// leaf shows its lower side for phi within `back` [rad] of pi: back = acos(flat / round), by its tangent.
struct Ripple {
  double flat, round, root, back;  // root = round sin(back); back is 0 where the leaf shows its upper side always

  Ripple(double cosine, double sine, double mu) : flat(cosine * mu), round(sine * sineOf(mu)), root(0.), back(0.) {
    const double square = (round - flat) * (round + flat);
    if (square <= 0.) return;
    root = std::sqrt(square);
    back = std::atan2(root, flat);
  }

  double mode(int m) const {
    if (m == 0) return flat + 2. / kPi * (root - flat * back);
    if (m == 1) return round + 2. / kPi * (flat * std::sin(back) - round * back);
    const double value =
        2. * round / (kPi * m) * (std::sin((m - 1) * back) / (m - 1) - std::sin((m + 1) * back) / (m + 1));
    return m % 2 == 0 ? value : -value;
  }
};

// Mean over the leaf's azimuth of |a + b cos x| |c + d cos(x - shift)|, b, d >= 0: the product's own integral between
// the places where one of the factors changes sign.
double meanModulus(double a, double b, double c, double d, double shift) {
  std::array<double, 5> edges{};  // rising
  std::size_t count = 0;
  const auto addZeros = [&](double flat, double round, double centre) {
    if (std::abs(flat) >= round) return;
    const double half = std::acos(-flat / round);
    for (double zero : {centre - half, centre + half}) {
      const double edge = zero - 2. * kPi * std::floor(zero / (2. * kPi));
      std::size_t place = count++;
      for (; place > 0 && edges[place - 1] > edge; --place) edges[place] = edges[place - 1];
      edges[place] = edge;
    }
  };
  addZeros(a, b, 0.);
  addZeros(c, d, shift);
  const double flat = a * c + 0.5 * b * d * std::cos(shift);
  if (count == 0) return std::abs(flat);
  edges[count] = edges[0] + 2. * kPi;
  const auto integral = [&](double x) {
    return flat * x + a * d * std::sin(x - shift) + c * b * std::sin(x) + 0.25 * b * d * std::sin(2. * x - shift);
  };
  double sum = 0., previous = integral(edges[0]);
  for (std::size_t i = 1; i <= count; ++i) {
    const double next = integral(edges[i]);
    sum += std::abs(next - previous);
    previous = next;
  }
  return sum / (2. * kPi);
}

}  // namespace

// (P20) The azimuth is integrated in closed form; the inclination has a kink where leaves begin to show both sides.
double leafProjection(const LeafAngles& angles, double mu) {
  require(0. <= mu && mu <= 1., "mu", mu, "within 0 .. 1");
  return angles.mean([mu](double t) { return Ripple(std::cos(t), std::sin(t), mu).mode(0); },
                     std::atan2(mu, sineOf(mu)));
}

// (P21)
void leafProjectionModes(const LeafAngles& angles, int mode, double mu, std::span<double> result) {
  assert(mode >= 0 && 0. <= mu && mu <= 1. && result.size() == angles.nodes().size());
  std::size_t r = 0;
  for (const LeafAngles::Node& node : angles.nodes()) result[r++] = Ripple(node.cosine, node.sine, mu).mode(mode);
}

// (P21)
double leafScattering(const LeafScattering& leaves, double mu, double mu_in, double azimuth) {
  assert(std::abs(mu) <= 1. && std::abs(mu_in) <= 1.);
  const double omega = leaves.reflectance + leaves.transmittance;
  const double contrast = leaves.reflectance - leaves.transmittance;
  const double sine = sineOf(mu), sine_in = sineOf(mu_in), turn = std::cos(azimuth);
  double sum = 0.;
  for (const LeafAngles::Node& node : leaves.angles.nodes()) {
    const double a = node.cosine * mu, b = node.sine * sine, c = node.cosine * mu_in, d = node.sine * sine_in;
    sum += node.weight * (omega * meanModulus(a, b, c, d, azimuth) - contrast * (a * c + 0.5 * b * d * turn));
  }
  return std::max(0., 0.5 * sum / kPi);
}

LeafProjections::LeafProjections(const LeafAngles& angles, std::span<const double> mus)
    : angles_(angles), nodes_(angles.nodes().size()), mus_(mus.begin(), mus.end()) {
  values_.resize(mus_.size() * nodes_);
  for (std::size_t i = 0; i < mus_.size(); ++i) {
    const std::span<double> row(values_.data() + i * nodes_, nodes_);
    leafProjectionModes(angles_, 0, mus_[i], row);
    double mean = 0.;
    for (std::size_t r = 0; r < nodes_; ++r) mean += angles_.nodes()[r].weight * row[r];
    projections_.push_back(leafProjection(angles_, mus_[i]));
    // Both are 0 together: flat leaves seen edge-on.
    if (mean > 0.)
      for (double& value : row) value *= projections_.back() / mean;
  }
  mean_mode_ = values_;
}

LeafProjections::LeafProjections(const LeafAngles& angles, std::span<const double> mus, std::span<const double> weights)
    : LeafProjections(angles, mus) {
  assert(mus.size() == weights.size());
  const std::vector<LeafAngles::Node>& nodes = angles_.nodes();
  double half = 0.;
  for (std::size_t i = 0; i < mus_.size(); ++i) half += weights[i] * projections_[i];
  const std::vector<double> wanted = projections_;
  // Sinkhorn & Knopp 1967. It ends with the inclinations: energy is exact, and projections_ is what then stands there.
  constexpr int kRounds = 20;
  for (int round = 0; round < kRounds; ++round) {
    for (std::size_t r = 0; r < nodes_; ++r) {
      double sum = 0.;
      for (std::size_t i = 0; i < mus_.size(); ++i) sum += weights[i] * mean_mode_[i * nodes_ + r];
      for (std::size_t i = 0; i < mus_.size(); ++i) mean_mode_[i * nodes_ + r] *= 0.5 / sum;
    }
    double off = 0.;
    for (std::size_t i = 0; i < mus_.size(); ++i) {
      double& projection = projections_[i] = 0.;
      for (std::size_t r = 0; r < nodes_; ++r) projection += nodes[r].weight * mean_mode_[i * nodes_ + r];
      off = std::max(off, std::abs(projection - wanted[i] * 0.5 / half));
    }
    if (off < 1e-14 || round + 1 == kRounds) break;
    for (std::size_t i = 0; i < mus_.size(); ++i)
      for (std::size_t r = 0; r < nodes_; ++r) mean_mode_[i * nodes_ + r] *= wanted[i] * 0.5 / half / projections_[i];
  }
  values_ = mean_mode_;
}

void LeafProjections::setMode(int mode) {
  assert(mode >= 0);
  if (mode == mode_) return;
  mode_ = mode;
  if (mode == 0) std::copy(mean_mode_.begin(), mean_mode_.end(), values_.begin());
  for (std::size_t i = 0; i < mus_.size() && mode > 0; ++i)
    leafProjectionModes(angles_, mode, mus_[i], {values_.data() + i * nodes_, nodes_});
}

// (P21)
void LeafKernel::evenOdd(double reflectance, double transmittance, std::span<double> even,
                         std::span<double> odd) const {
  assert(even.size() == modulus.size() && odd.size() == modulus.size());
  const double omega = reflectance + transmittance, contrast = reflectance - transmittance;
  const std::span<double> of_modulus = mode % 2 == 0 ? even : odd, of_cosine = mode % 2 == 0 ? odd : even;
  for (std::size_t k = 0; k < modulus.size(); ++k) {
    of_modulus[k] = omega * modulus[k];
    of_cosine[k] = cosine.empty() ? 0. : -contrast * cosine[k];
  }
}

// (P21) The mean over the leaf's azimuth keeps A_m A'_m / 2 of mode m, A_0 A'_0 of mode 0; the integral over mu' of
// both hemispheres doubles what has the kernel's parity.
void fillLeafKernel(const LeafProjections& rows, const LeafProjections& columns, LeafKernel& kernel) {
  assert(rows.mode() == columns.mode() && rows.angles() == columns.angles());
  const std::vector<LeafAngles::Node>& nodes = rows.angles().nodes();
  const std::size_t n = rows.size(), m = columns.size();
  kernel.mode = rows.mode();
  kernel.modulus.resize(n * m);
  kernel.cosine.resize(kernel.mode < 2 ? n * m : 0);
  const double factor = kernel.mode == 0 ? 2. : 0.5;
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = 0; j < m; ++j) {
      const std::span<const double> a = rows.values(i), b = columns.values(j);
      double sum = 0.;
      for (std::size_t r = 0; r < nodes.size(); ++r) sum += nodes[r].weight * a[r] * b[r];
      kernel.modulus[i * m + j] = factor * sum;
    }
  if (kernel.mode >= 2) return;
  double square =
      0.;  // mean of cos^2 or sin^2 of the inclination: B_0 = cos(theta_L) mu, B_1 = sin(theta_L) sin(theta)
  for (const LeafAngles::Node& node : nodes)
    square += node.weight * (kernel.mode == 0 ? node.cosine * node.cosine : node.sine * node.sine);
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = 0; j < m; ++j)
      kernel.cosine[i * m + j] =
          factor * square *
          (kernel.mode == 0 ? rows.mu(i) * columns.mu(j) : sineOf(rows.mu(i)) * sineOf(columns.mu(j)));
}

}  // namespace sunfleck

#include "sky/sky_sampler.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

namespace sunfleck {
namespace {

constexpr double kPi = std::numbers::pi;

int axisOf(SkyMeasure measure) {
  return static_cast<int>(measure) - static_cast<int>(SkyMeasure::through_x);
}

// With the zenith angle a and the azimuth b from the axis, all measures are products of one of either, d(zenith) and
// d(azimuth); these are their integrals from 0 on. Solid angle: sin a and 1. Through z: sin a cos a and 1. Through x or
// y: sin^2 a and |cos b|.
double zenithIntegral(SkyMeasure measure, double a) {
  if (measure == SkyMeasure::solid_angle) return 2. * std::pow(std::sin(0.5 * a), 2);
  if (measure == SkyMeasure::through_z) return 0.5 * std::pow(std::sin(a), 2);
  return 0.5 * (a - std::sin(a) * std::cos(a));
}

double azimuthIntegral(SkyMeasure measure, double b) {
  if (measure == SkyMeasure::solid_angle || measure == SkyMeasure::through_z) return b;
  const double half_turns = std::round(b / kPi);
  return 2. * half_turns + std::sin(b - half_turns * kPi);
}

double zenithOf(SkyMeasure measure, double integral) {
  if (measure == SkyMeasure::solid_angle) return 2. * std::asin(std::sqrt(std::min(0.5 * integral, 1.)));
  if (measure == SkyMeasure::through_z) return std::asin(std::sqrt(std::min(2. * integral, 1.)));
  // Newton's method from above: the integral is convex, so that it comes down to the root without passing it.
  double a = std::min(1.3 * std::cbrt(3. * integral), 0.5 * kPi);  // a / cbrt(3 integral) is 1 .. 1.19
  for (int step = 0; step < 50 && a > 0.; ++step) {
    const double change = (zenithIntegral(measure, a) - integral) / std::pow(std::sin(a), 2);
    a = std::clamp(a - change, 0., 0.5 * kPi);
    if (std::abs(change) < 1e-9) break;
  }
  return a;
}

double azimuthOf(SkyMeasure measure, double integral) {
  if (measure == SkyMeasure::solid_angle || measure == SkyMeasure::through_z) return integral;
  const double half_turns = std::round(0.5 * integral);
  return half_turns * kPi + std::asin(std::clamp(integral - 2. * half_turns, -1., 1.));
}

// From the axis of the measure to where the map's columns begin.
double firstAzimuth(const SkyMap& sky, SkyMeasure measure) {
  return double{sky.firstAzimuth()} - (measure == SkyMeasure::through_y ? 0.5 * kPi : 0.);
}

// What the rows and the columns of a map measure; a cell measures the product.
struct CellMeasures {
  CellMeasures(const SkyMap& sky, SkyMeasure measure) {
    const double row_step = 0.5 * kPi / sky.rows(), column_step = 2. * kPi / sky.columns();
    const double first = firstAzimuth(sky, measure);
    for (int row = 0; row < sky.rows(); ++row)
      of_rows.push_back(zenithIntegral(measure, (row + 1) * row_step) - zenithIntegral(measure, row * row_step));
    for (int i = 0; i < sky.columns(); ++i)
      of_columns.push_back(azimuthIntegral(measure, first + (i + 1) * column_step) -
                           azimuthIntegral(measure, first + i * column_step));
  }
  std::vector<double> of_rows, of_columns;
};

template <typename T>
std::size_t intervalOf(const T* first, std::size_t count, T at) {
  const T* const above = std::upper_bound(first + 1, first + count, at);
  return static_cast<std::size_t>(above - first) - 1;
}

}  // namespace

glm::dvec3 integral(const SkyMap& sky, SkyMeasure measure) {
  const CellMeasures measures(sky, measure);
  glm::dvec3 sum(0.);
  std::size_t cell = 0;
  for (const double of_row : measures.of_rows)
    for (const double of_column : measures.of_columns) sum += of_row * of_column * glm::dvec3(sky.radiance(cell++));
  return sum;
}

SkySampler::SkySampler(const SkyMap& sky, const glm::dvec3& weights, SkyMeasure measure)
    : sky_(&sky), measure_(measure) {
  const auto rows = static_cast<std::size_t>(sky.rows()), columns = static_cast<std::size_t>(sky.columns());
  CellMeasures measures(sky, measure);
  row_measure_ = std::move(measures.of_rows);
  column_measure_ = std::move(measures.of_columns);
  rows_.assign(rows + 1, 0.);
  columns_.assign(rows * (columns + 1), 0.f);
  std::vector<double> cumulative(columns + 1);
  for (std::size_t row = 0; row < rows; ++row) {
    for (std::size_t i = 0; i < columns; ++i) {
      const glm::dvec3 radiance(sky.radiance(row * columns + i));
      cumulative[i + 1] = cumulative[i] + glm::dot(radiance, weights) * column_measure_[i];
    }
    const double of_row = cumulative[columns];
    for (std::size_t i = 1; i <= columns; ++i)
      columns_[row * (columns + 1) + i] = of_row > 0. ? static_cast<float>(cumulative[i] / of_row) : 0.f;
    rows_[row + 1] = rows_[row] + of_row * row_measure_[row];
  }
  total_ = rows_[rows];
  if (total_ > 0.)
    for (double& share : rows_) share /= total_;
}

SkySample SkySampler::sample(float u, float v) const {
  const auto columns = static_cast<std::size_t>(sky_->columns());
  const std::size_t row = intervalOf(rows_.data(), rows_.size() - 1, double{u});
  const float* const of_row = columns_.data() + row * (columns + 1);
  const std::size_t column = intervalOf(of_row, columns, v);
  const double in_row = (double{u} - rows_[row]) / (rows_[row + 1] - rows_[row]);
  const double in_column = (double{v} - double{of_row[column]}) / (double{of_row[column + 1]} - double{of_row[column]});
  const double row_step = 0.5 * kPi / sky_->rows(), column_step = 2. * kPi / sky_->columns();
  const double first = firstAzimuth(*sky_, measure_);
  const double from_axis =
      azimuthOf(measure_, azimuthIntegral(measure_, first + static_cast<double>(column) * column_step) +
                              in_column * column_measure_[column]);
  const double azimuth = from_axis + double{sky_->firstAzimuth()} - first;
  const double zenith =
      zenithOf(measure_, zenithIntegral(measure_, static_cast<double>(row) * row_step) + in_row * row_measure_[row]);
  const double sine = std::sin(zenith);
  SkySample sample{.cell = row * columns + column};
  // Above the horizon whatever rounding does.
  sample.to_sky = {static_cast<float>(sine * std::cos(azimuth)), static_cast<float>(sine * std::sin(azimuth)),
                   std::max(static_cast<float>(std::cos(zenith)), 1e-7f)};
  sample.density = densityIn(sample.cell, sample.to_sky);
  return sample;
}

float SkySampler::densityIn(std::size_t cell, const glm::vec3& to_sky) const {
  const auto columns = static_cast<std::size_t>(sky_->columns());
  const std::size_t row = cell / columns, column = cell % columns;
  const float* const of_column = columns_.data() + row * (columns + 1) + column;
  const double share = (rows_[row + 1] - rows_[row]) * (double{of_column[1]} - double{of_column[0]});
  const double measure = row_measure_[row] * column_measure_[column];
  const float per_angle = measure_ == SkyMeasure::solid_angle ? 1.f : std::abs(to_sky[axisOf(measure_)]);
  return static_cast<float>(share / measure) * per_angle;
}

}  // namespace sunfleck

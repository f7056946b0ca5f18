#include "field/grid_field.hpp"

#include <fmt/format.h>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <numbers>

#include "core/available_memory.hpp"
#include "core/require.hpp"
#include "field/anderson.hpp"
#include "field/detail/cell_exchange.hpp"
#include "field/detail/sweep_row.hpp"

namespace sunfleck {
namespace {

constexpr std::size_t kLanes = SphereOrdinates::kLanes;
constexpr float kPi = std::numbers::pi_v<float>;
constexpr std::size_t kAsk = 4096;  // cells after which it is asked whether to go on
constexpr std::size_t kKept = 6;    // steps that Anderson's acceleration looks back
static_assert(GridField::kMostBands == detail::kMostFieldBands);

// Directions of the upper half, rows as the exchange reads them.
struct UpperHalf {
  std::vector<float> x, y, z, weight;
  explicit UpperHalf(const SphereOrdinates& ordinates) {
    for (std::size_t i = 0; i < ordinates.size() / 2; ++i) {
      x.push_back(ordinates.direction(i).x);
      y.push_back(ordinates.direction(i).y);
      z.push_back(ordinates.direction(i).z);
      weight.push_back(ordinates.weight(i));
    }
  }
  detail::ExchangeRows rows() const { return {x.size() / kLanes, x.data(), y.data(), z.data(), weight.data()}; }
};

template <typename Work>
void forEach(std::size_t count, std::size_t grain, const Work& work) {
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count, grain), [&](const auto& range) {
    for (std::size_t i = range.begin(); i < range.end(); ++i) work(i);
  });
}

float albedo(const GridOptics& optics, bool wood) {
  return wood ? optics.wood_reflectance : optics.leaf.albedo();
}

// (F17) How far irradiances may be from their fixed point, by how far the last step has changed them: the sum of
// changes falls from step to step by the share of the light that stays, which is no larger than the largest albedo, and
// smaller where light can leave.
class ErrorBound {
 public:
  ErrorBound(std::span<const float> weights, std::size_t sides, double albedo)
      : weights_(weights), sides_(sides), albedo_(albedo) {}

  //   x, g         irradiances, and what is at walls, before and after a step
  //   wall_change  of power at the walls
  // Returns the bound on the sum of errors of irradiance times area, by their sum.
  double operator()(const std::vector<float>& x, const std::vector<float>& g, double wall_change) {
    double change = 0., total = 0., moved = 0., kept = 0.;
    for (std::size_t i = 0; i < x.size(); ++i) {
      const double weight = weights_[i];
      if (i < sides_) {
        change += weight * std::abs(double{g[i]} - double{x[i]});
        total += weight * double{g[i]};
      }
      if (!last_x_.empty()) {
        moved += weight * std::abs(double{x[i]} - double{last_x_[i]});
        kept += weight * std::abs(double{g[i]} - double{last_g_[i]});
      }
    }
    // Steps are mostly along what is slowest to leave, but not wholly: half of the share that leaves is trusted. One
    // that seems to make light tells nothing: it has brought light from walls, which are weighed only roughly, to
    // leaves.
    if (kept < moved) staying_ = std::max(staying_, kept / moved);
    const double stays = staying_ > 0. ? std::min(albedo_, 0.5 * (1. + staying_)) : albedo_;
    last_x_ = x;
    last_g_ = g;
    if (total == 0. && change == 0.) return 0.;
    return stays < 1. && total > 0. ? (stays * change + wall_change) / ((1. - stays) * total)
                                    : std::numeric_limits<double>::infinity();
  }

 private:
  std::span<const float> weights_;
  std::size_t sides_;
  double albedo_, staying_ = 0.;
  std::vector<float> last_x_, last_g_;
};

}  // namespace

// One solution under way.
struct GridField::State {
  UpperHalf half;
  Sweep sweep;
  std::vector<float> direct;        // as the elements' areas count: of wood on either side
  std::vector<float> irradiance;    // of each element, side and band
  std::vector<float> radiance;      // that elements send, likewise
  std::vector<float> source, mean;  // in cells
  std::vector<float> of_pieces;     // irradiance of each piece, side and band
};

GridField::GridField(CellMedium medium, std::span<const float> clumping, const SphereOrdinates& ordinates)
    : medium_(std::move(medium)), ordinates_(ordinates) {
  for (const float omega : clumping) require(omega > 0.f && omega <= 1.f, "clumping", omega, "above 0, 1 at most");
  const UpperHalf half(ordinates_);
  const std::size_t elements = medium_.area.size(), slots = medium_.grid.cells.size();
  fullness_.resize(elements);
  forEach(elements, 256, [&](std::size_t i) {
    if (medium_.normal[i] == glm::vec3(0.f)) {  // half of its area is seen from anywhere
      fullness_[i] = 1.f;
      return;
    }
    float sum = 0.f;
    for (std::size_t k = 0; k < half.x.size(); ++k)
      sum +=
          2.f * half.weight[k] *
          std::abs(half.x[k] * medium_.normal[i].x + half.y[k] * medium_.normal[i].y + half.z[k] * medium_.normal[i].z);
    fullness_[i] = 2.f * kPi / sum;
  });
  clumping_.resize(slots);
  staying_.resize(slots);
  const std::size_t pairs = ordinates_.rows() / 2;
  extinction_.resize(pairs * slots * kLanes);
  forEach(slots, 16, [&](std::size_t slot) {
    const CellPiece* const begin = medium_.pieces.data() + medium_.first_piece[slot];
    const CellPiece* const end = medium_.pieces.data() + medium_.first_piece[slot + 1];
    double area = 0., clumped = 0.;
    for (const CellPiece* piece = begin; piece != end; ++piece) {
      const std::size_t kind = medium_.material[piece->element] / 2;
      area += double{piece->area};
      clumped += double{piece->area} * (kind < clumping.size() ? double{clumping[kind]} : 1.);
    }
    clumping_[slot] = area > 0. ? static_cast<float>(clumped / area) : 1.f;
    std::vector<float> sigma(pairs * kLanes);
    detail::cellExchange().extinction(half.rows(), {medium_.normal.data(), fullness_.data()}, begin, end,
                                      clumping_[slot] / medium_.grid.volume(), sigma.data());
    double sent = 0., met = 0.;
    for (std::size_t i = 0; i < sigma.size(); ++i) {
      const glm::vec3 out = glm::abs(ordinates_.direction(i)) / (detail::kOutwardShare * medium_.grid.side);
      const double weight = double{half.weight[i] * sigma[i]};
      sent += weight;
      met += sigma[i] > 0.f ? weight * double{sigma[i] / (sigma[i] + out.x + out.y + out.z)} : 0.;
    }
    staying_[slot] = 1.f - clumping_[slot] + (sent > 0. ? clumping_[slot] * static_cast<float>(met / sent) : 0.f);
    for (std::size_t row = 0; row < pairs; ++row)
      std::copy_n(sigma.data() + row * kLanes, kLanes, extinction_.data() + (row * slots + slot) * kLanes);
  });
}

GridField::~GridField() = default;
GridField::GridField(GridField&&) noexcept = default;
GridField& GridField::operator=(GridField&&) noexcept = default;

double GridField::memoryBytes(std::size_t bands) const {
  const auto elements = static_cast<double>(medium_.area.size()), pieces = static_cast<double>(medium_.pieces.size()),
             sets = static_cast<double>(bands);
  const double state = 2. * elements * sets;  // of every value the acceleration keeps
  const double walls = medium_.grid.periodic ? static_cast<double>(ordinates_.size()) * sets * medium_.grid.size.z *
                                                   (medium_.grid.size.x + medium_.grid.size.y)
                                             : 0.;
  return Sweep::memoryBytes(medium_.grid, ordinates_, bands) + 48. * elements + 12. * pieces +
         4. * (2. * pieces * sets + 3. * state + (2. * kKept + 5.) * (state + walls));
}

EnteringLight GridField::evenSky(std::span<const float> sky, std::span<const float> ground,
                                 std::vector<float> ground_albedo) const {
  const std::size_t bands = sky.size();
  EnteringLight entering{.radiance = std::vector<float>(ordinates_.size() * bands),
                         .ground_albedo = std::move(ground_albedo)};
  for (std::size_t row = 0; row < ordinates_.rows(); ++row)
    for (std::size_t band = 0; band < bands; ++band)
      std::fill_n(entering.radiance.data() + (row * bands + band) * kLanes, kLanes,
                  ordinates_.direction(row * kLanes).z < 0.f ? sky[band] : ground[band]);
  return entering;
}

void GridField::validate(const GridLight& light) const {
  const std::size_t bands = light.bands(), elements = medium_.area.size();
  require(bands >= 1 && bands <= kMostBands, "bands of the field", bands, "1 to 4");
  const auto share = [](const char* what, float value) {
    require(value >= 0.f && value <= 1.f, what, value, "0 to 1");
  };
  std::uint32_t kinds = 0;
  for (const std::uint32_t material : medium_.material) kinds = std::max(kinds, material / 2 + 1);
  for (const auto& of_kinds : light.optics) {
    require(of_kinds.size() >= kinds, "optics of kinds of trees", of_kinds.size(), "one for each kind");
    for (const GridOptics& optics : of_kinds) {
      sunfleck::validate(optics.leaf);
      share("wood reflectance", optics.wood_reflectance);
    }
  }
  const auto fits = [&](const char* what, const std::vector<float>& values, std::size_t size) {
    require(values.size() == size, what, values.size(), fmt::format("{} figures", size));
    for (const float value : values)
      require(value >= 0.f && std::isfinite(value), what, value, "finite and not negative");
  };
  fits("direct light of elements", light.direct, elements * 2 * bands);
  fits("light from outside", light.entering.radiance, ordinates_.size() * bands);
  if (!light.entering.ground_albedo.empty()) {
    fits("ground albedo", light.entering.ground_albedo, bands);
    for (const float value : light.entering.ground_albedo) share("ground albedo", value);
  }
  if (!light.entering.ground_irradiance.empty())
    fits("light on the ground", light.entering.ground_irradiance,
         static_cast<std::size_t>(medium_.grid.size.x) * static_cast<std::size_t>(medium_.grid.size.y) * bands);
  const double bytes = memoryBytes(bands), room = availableMemory();
  if (bytes > room)
    throw InvalidInput(
        fmt::format("the field needs {:.1f} GB of memory and there are {:.1f}: must be fewer trees or "
                    "larger cells",
                    1e-9 * bytes, 1e-9 * room));
}

// (F17) What elements receive when they send what they sent of state.irradiance: replaces it.
void GridField::step(State& state, const GridLight& light, SharedProgress& progress) {
  const std::size_t bands = light.bands(), slots = medium_.grid.cells.size(), pairs = ordinates_.rows() / 2,
                    stride = bands * kLanes;
  const detail::ExchangeRows rows = state.half.rows();
  const detail::ExchangeElements elements{medium_.normal.data(), fullness_.data()};
  const detail::CellExchange exchange = detail::cellExchange();
  forEach(medium_.area.size(), 1024, [&](std::size_t i) {
    const std::uint32_t material = medium_.material[i];
    for (std::size_t band = 0; band < bands; ++band) {
      const GridOptics& optics = light.optics[band][material / 2];
      const bool wood = material % 2 == 1;
      const float same = (wood ? optics.wood_reflectance : optics.leaf.reflectance) / kPi,
                  other = wood ? 0.f : optics.leaf.transmittance / kPi;
      const std::size_t front = i * 2 * bands + band, back = front + bands;
      const float e_front = state.irradiance[front], e_back = state.irradiance[back];
      state.radiance[front] = same * e_front + other * e_back;
      state.radiance[back] = same * e_back + other * e_front;
    }
  });
  const auto pieces = [&](std::size_t slot) {
    return std::pair(medium_.pieces.data() + medium_.first_piece[slot],
                     medium_.pieces.data() + medium_.first_piece[slot + 1]);
  };
  // Where a row of the exchange stands in the grid: those that go down follow the upper ones' opposites.
  const auto place = [&](std::size_t row, std::size_t slot) {
    return state.sweep.place(row < pairs ? row : ordinates_.opposite(row - pairs), slot);
  };
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, slots, 16), [&](const auto& range) {
    std::vector<float> of_cell(2 * pairs * stride);
    for (std::size_t slot = range.begin(); slot < range.end(); ++slot) {
      if (slot % kAsk == 0) progress.ask();
      const auto [begin, end] = pieces(slot);
      exchange.send(rows, elements, begin, end, clumping_[slot] / medium_.grid.volume(), state.radiance.data(), bands,
                    of_cell.data());
      for (std::size_t row = 0; row < 2 * pairs; ++row)
        std::copy_n(of_cell.data() + row * stride, stride, state.source.data() + place(row, slot));
    }
  });
  state.sweep.follow(extinction_, state.source, light.entering, state.mean);
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, slots, 16), [&](const auto& range) {
    std::vector<float> met(2 * pairs * stride);
    for (std::size_t slot = range.begin(); slot < range.end(); ++slot) {
      if (slot % kAsk == 0) progress.ask();
      // Of what leaves meet, the share 1 - Omega is from leaves of their own clump.
      const float open = clumping_[slot];
      for (std::size_t row = 0; row < 2 * pairs; ++row) {
        const float* const extinction = extinction_.data() + ((row % pairs) * slots + slot) * kLanes;
        const std::size_t at = place(row, slot);
        for (std::size_t i = 0; i < stride; ++i) {
          const float sigma = extinction[i % kLanes];
          const float own = sigma > 0.f ? state.source[at + i] / sigma : 0.f;
          met[row * stride + i] = open * state.mean[at + i] + (1.f - open) * own;
        }
      }
      const auto [begin, end] = pieces(slot);
      exchange.receive(rows, elements, begin, end, met.data(), bands,
                       state.of_pieces.data() + std::size_t{medium_.first_piece[slot]} * 2 * bands);
    }
  });
  forEach(medium_.area.size(), 1024, [&](std::size_t i) {
    for (std::size_t k = 0; k < 2 * bands; ++k) {
      float sum = 0.f;
      for (std::uint32_t p = medium_.first_of[i]; p < medium_.first_of[i + 1]; ++p) {
        const std::size_t piece = medium_.of_element[p];
        sum += medium_.pieces[piece].area * state.of_pieces[piece * 2 * bands + k];
      }
      state.irradiance[i * 2 * bands + k] = state.direct[i * 2 * bands + k] + sum / medium_.area[i];
    }
  });
}

// (F18) Adds to g, made of x by a step, what the leaves of each cell would go on to exchange among themselves of the
// change. It leaves a fixed point where it is, and spares dense cells the steps that this would take.
void GridField::settleCells(const GridLight& light, std::size_t band, std::span<const float> x,
                            std::span<float> g) const {
  const std::size_t slots = medium_.grid.cells.size();
  std::vector<float> more(slots);
  forEach(slots, 64, [&](std::size_t slot) {
    double area = 0., scattered = 0., change = 0.;
    for (std::uint32_t i = medium_.first_piece[slot]; i < medium_.first_piece[slot + 1]; ++i) {
      const CellPiece& piece = medium_.pieces[i];
      const std::size_t front = 2 * std::size_t{piece.element};
      const std::uint32_t material = medium_.material[piece.element];
      const double share = piece.area;
      area += share;
      scattered += share * double{albedo(light.optics[band][material / 2], material % 2 == 1)};
      change += 0.5 * share * double{(g[front] - x[front]) + (g[front + 1] - x[front + 1])};
    }
    const double again = area > 0. ? double{staying_[slot]} * scattered / area : 0.;
    if (again < 1.) more[slot] = static_cast<float>(change / std::max(area, 1e-30) * again / (1. - again));
  });
  std::vector<std::uint32_t> slot_of(medium_.pieces.size());
  forEach(slots, 64, [&](std::size_t slot) {
    std::fill(slot_of.begin() + medium_.first_piece[slot], slot_of.begin() + medium_.first_piece[slot + 1],
              static_cast<std::uint32_t>(slot));
  });
  forEach(medium_.area.size(), 1024, [&](std::size_t i) {
    float sum = 0.f;
    for (std::uint32_t p = medium_.first_of[i]; p < medium_.first_of[i + 1]; ++p) {
      const std::size_t piece = medium_.of_element[p];
      sum += medium_.pieces[piece].area * more[slot_of[piece]];
    }
    g[2 * i] += sum / medium_.area[i];
    g[2 * i + 1] += sum / medium_.area[i];
  });
}

// (F17)
GridSolution GridField::solve(const GridLight& light, const GridEffort& effort, const Progress& progress) {
  validate(light);
  const std::size_t bands = light.bands(), elements = medium_.area.size(), sides = 2 * elements;
  Sweep sweep(medium_.grid, ordinates_, bands);
  const std::size_t of_cells = sweep.size();
  State state{.half = UpperHalf(ordinates_),
              .sweep = std::move(sweep),
              .direct = light.direct,
              .irradiance = {},
              .radiance = std::vector<float>(sides * bands),
              .source = std::vector<float>(of_cells),
              .mean = std::vector<float>(of_cells),
              .of_pieces = std::vector<float>(medium_.pieces.size() * 2 * bands)};
  // Wood counts half of its surface on either side.
  for (std::size_t i = 0; i < elements; ++i)
    if (medium_.material[i] % 2 == 1)
      for (std::size_t k = 0; k < 2 * bands; ++k) state.direct[i * 2 * bands + k] *= 2.f;
  state.irradiance = state.direct;

  const bool periodic = medium_.grid.periodic;
  const std::size_t walls = periodic ? state.sweep.walls().size() / bands : 0;
  std::vector<float> weights(sides + walls);
  for (std::size_t i = 0; i < sides; ++i) weights[i] = medium_.area[i / 2];
  for (std::size_t i = 0; i < walls; ++i) {
    // As irradiance of the faces of cells, roughly: what matters is that both kinds of residual fall alike.
    const std::size_t lane = i / (walls / ordinates_.rows()) * kLanes + i % kLanes;
    weights[sides + i] = ordinates_.weight(lane) * kPi * medium_.grid.side.z * medium_.grid.side.x;
  }
  std::vector<Anderson> mixers(bands, Anderson(kKept, weights));
  // Band by band: irradiances, then what is at the walls.
  const auto gather = [&](std::size_t band) {
    std::vector<float> values(sides + walls);
    for (std::size_t i = 0; i < sides; ++i) values[i] = state.irradiance[i * bands + band];
    const auto faces = state.sweep.walls();
    for (std::size_t i = 0; i < walls; ++i)
      values[sides + i] = faces[(i / kLanes * bands + band) * kLanes + i % kLanes];
    return values;
  };
  const auto scatter = [&](std::size_t band, std::span<const float> values) {
    for (std::size_t i = 0; i < sides; ++i) state.irradiance[i * bands + band] = values[i];
    const auto faces = state.sweep.walls();
    for (std::size_t i = 0; i < walls; ++i)
      faces[(i / kLanes * bands + band) * kLanes + i % kLanes] = values[sides + i];
  };

  std::vector<ErrorBound> bounds;
  for (const auto& of_kinds : light.optics) {
    double most = 0.;
    for (const GridOptics& optics : of_kinds)
      most = std::max({most, double{albedo(optics, false)}, double{albedo(optics, true)}});
    bounds.emplace_back(weights, sides, most);
  }
  GridSolution solution;
  double first_bound = 0., share = 0.;
  const Progress again = [&](double) { return goOn(progress, share); };
  SharedProgress within(again, 1.);
  for (;;) {
    std::vector<std::vector<float>> values, found;
    for (std::size_t band = 0; band < bands; ++band) values.push_back(gather(band));
    step(state, light, within);
    ++solution.iterations;
    solution.error_bound = 0.;
    bool steady = true;
    for (std::size_t band = 0; band < bands; ++band) {
      found.push_back(gather(band));
      const double bound = bounds[band](values[band], found[band], state.sweep.wallChange(band));
      steady = steady && bound <= double{effort.error};
      solution.error_bound = std::max(solution.error_bound, bound);
    }
    if (steady) break;
    if (solution.iterations >= effort.iterations) {
      solution.told = fmt::format("the field is not steady after {} iterations: its error may be {:.1g}",
                                  solution.iterations, solution.error_bound);
      break;
    }
    // Bounds fall by about the same factor each time.
    if (solution.iterations == 1 || !std::isfinite(first_bound)) first_bound = solution.error_bound;
    const double falls = std::log(first_bound / solution.error_bound),
                 must_fall = std::log(first_bound / double{effort.error});
    share = std::max(share, falls > 0. && falls < must_fall ? falls / must_fall : 0.);
    requireGoOn(progress, share);
    for (std::size_t band = 0; band < bands; ++band) {
      settleCells(light, band, values[band], found[band]);
      mixers[band].next(values[band], found[band]);
      for (float& value : values[band]) value = std::max(value, 0.f);  // no mixture of light is darker than none
      scatter(band, values[band]);
    }
  }

  // Where the light has gone.
  const glm::ivec3 size = medium_.grid.size;
  const auto columns = static_cast<std::size_t>(size.x) * static_cast<std::size_t>(size.y);
  const double column = double{medium_.grid.side.x} * double{medium_.grid.side.y};
  solution.ground_irradiance.assign(state.sweep.groundIrradiance().begin(), state.sweep.groundIrradiance().end());
  for (std::size_t band = 0; band < bands; ++band) {
    GridBalance balance;
    double direct = 0., leaves = 0., wood = 0., on_ground = 0., ground = 0.;
    for (std::size_t i = 0; i < sides; ++i) {
      const std::uint32_t material = medium_.material[i / 2];
      const double area = medium_.area[i / 2];
      direct += area * double{state.direct[i * bands + band]};
      (material % 2 == 1 ? wood : leaves) += area * double{state.irradiance[i * bands + band]} *
                                             (1. - double{albedo(light.optics[band][material / 2], material % 2 == 1)});
    }
    for (std::size_t i = 0; i < columns; ++i) {
      if (!light.entering.ground_irradiance.empty())
        on_ground += column * double{light.entering.ground_irradiance[i * bands + band]};
      ground += column * double{solution.ground_irradiance[i * bands + band]};
    }
    const Sweep::Powers leaving = state.sweep.leaving(band);
    const bool has_ground = !light.entering.ground_albedo.empty();
    balance.incoming = direct + on_ground + state.sweep.enteringPower(light.entering, band);
    const double all = balance.incoming > 0. ? balance.incoming : 1.;
    balance.absorbed_leaves = leaves / all;
    balance.absorbed_wood = wood / all;
    balance.arriving_ground = has_ground ? ground / all : 0.;
    balance.absorbed_ground = has_ground ? ground * (1. - double{light.entering.ground_albedo[band]}) / all : 0.;
    balance.upward = leaving.top / all;
    balance.elsewhere = (leaving.sides + (has_ground ? 0. : leaving.bottom)) / all;
    solution.balance.push_back(balance);
  }
  solution.irradiance = std::move(state.irradiance);
  for (std::size_t i = 0; i < elements; ++i)
    if (medium_.material[i] % 2 == 1)
      for (std::size_t band = 0; band < bands; ++band) {
        float &front = solution.irradiance[i * 2 * bands + band],
              &back = solution.irradiance[i * 2 * bands + bands + band];
        front = 0.5f * (front + back);
        back = 0.f;
      }
  return solution;
}

}  // namespace sunfleck

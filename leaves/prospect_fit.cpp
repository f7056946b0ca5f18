#include "leaves/prospect_fit.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/require.hpp"
#include "leaves/detail/bounded_least_squares.hpp"
#include "leaves/prospect.hpp"

namespace sunfleck {
namespace {

using State = FittedContent::State;

constexpr LeafContents kStart{.anthocyanins = 1., .brown_pigments = 0.05};
constexpr LeafContents kStartOfParts{
    .anthocyanins = 1., .brown_pigments = 0.05, .dry_matter = 0., .protein = 0.001, .carbon_constituents = 0.008};
constexpr double kLeastInfluence = 2e-3;  // of a content over its whole range, on the data in the mean, to be sought
constexpr double kStarts[] = {1.3, 2.2};  // structures to begin with: one valley each has been enough

void requireMeasured(const MeasuredSpectrum& measured) {
  const std::size_t count = measured.wavelengths.size();
  require(!measured.reflectance.empty() || !measured.transmittance.empty(), "measured values", 0, "at least one");
  const std::pair<const std::vector<double>*, const char*> columns[] = {{&measured.reflectance, "reflectance"},
                                                                        {&measured.transmittance, "transmittance"}};
  for (const auto& [values, name] : columns) {
    if (values->empty()) continue;
    require(values->size() == count, fmt::format("number of values of {}", name), values->size(),
            "that of the wavelengths");
    for (std::size_t i = 0; i < count; ++i)
      require((*values)[i] >= -0.1 && (*values)[i] <= 1.1, fmt::format("{} at {} nm", name, measured.wavelengths[i]),
              (*values)[i], "in [-0.1, 1.1]");
  }
}

class Fitting {
 public:
  Fitting(const MeasuredSpectrum& measured, const ProspectFitSettings& settings)
      : measured_(measured), model_(measured.wavelengths), start_(settings.parts ? kStartOfParts : kStart) {
    std::vector<char> held(leafContents().size());
    for (const auto& [name, value] : settings.held) {
      const auto index = static_cast<std::size_t>(&leafContent(name, "held ") - leafContents().data());
      if (held[index]) throw InvalidInput("held " + name + ": must be there once");
      held[index] = true;
      start_.*leafContents()[index].value = value;
    }
    for (std::size_t i = 0; i < leafContents().size(); ++i) {
      const LeafContent& content = leafContents()[i];
      const bool part = content.name == "protein" || content.name == "carbon_constituents";
      if (settings.parts ? content.name == "dry_matter" : part) {
        if (held[i] && start_.*content.value != 0.)
          throw InvalidInput(fmt::format("held {}: must be a content of this kind of leaf", content.name));
        continue;
      }
      State state = held[i] ? State::held : State::found;
      each_.push_back({.content = &content, .state = state, .value = start_.*content.value});
    }
    validate(start_, "held ");
    findUnseen();
    if (data() < sought_.size())
      throw InvalidInput(fmt::format("measured values = {}: must be at least as many as the {} contents to find",
                                     data(), sought_.size()));
  }

  ProspectFit best() {
    std::optional<detail::BoundedFit> best;
    const bool free_structure = each_.front().state == State::found;
    for (const double structure : kStarts) {
      if (free_structure) start_.structure = structure;
      detail::BoundedFit fit = fitFrom(start_);
      if (!best || fit.squares < best->squares) best = std::move(fit);
      if (!free_structure) break;
    }
    return told(*best);
  }

 private:
  std::size_t data() const { return measured_.reflectance.size() + measured_.transmittance.size(); }
  double range(std::size_t i) const { return each_[i].content->usual_high - each_[i].content->low; }

  // Visits what is measured: data index, wavelength index, whether it is reflectance, its value.
  template <typename Visit>
  void forData(const Visit& visit) const {
    Eigen::Index datum = 0;
    for (std::size_t i = 0; i < measured_.reflectance.size(); ++i) visit(datum++, i, true, measured_.reflectance[i]);
    for (std::size_t i = 0; i < measured_.transmittance.size(); ++i)
      visit(datum++, i, false, measured_.transmittance[i]);
  }

  // Slopes by each content over its range.
  Eigen::MatrixXd slopesAt(const LeafContents& leaf) const {
    std::vector<LeafSides> slopes(leafContents().size() * model_.size());
    model_.differentiate(leaf, slopes);
    Eigen::MatrixXd all(static_cast<Eigen::Index>(data()), static_cast<Eigen::Index>(each_.size()));
    for (std::size_t c = 0; c < each_.size(); ++c) {
      const auto column = static_cast<std::size_t>(each_[c].content - leafContents().data());
      forData([&](Eigen::Index datum, std::size_t i, bool reflected, double) {
        const LeafSides& slope = slopes[column * model_.size() + i];
        all(datum, static_cast<Eigen::Index>(c)) = (reflected ? slope.reflectance : slope.transmittance) * range(c);
      });
    }
    return all;
  }

  void findUnseen() {
    const Eigen::MatrixXd slopes = slopesAt(start_);
    for (std::size_t c = 0; c < each_.size(); ++c) {
      if (each_[c].state != State::found) continue;
      const double influence = slopes.col(static_cast<Eigen::Index>(c)).norm() / std::sqrt(static_cast<double>(data()));
      if (influence < kLeastInfluence)
        each_[c].state = State::unseen;
      else
        sought_.push_back(static_cast<Eigen::Index>(c));
    }
  }

  LeafContents leafOf(const Eigen::VectorXd& parameters) const {
    LeafContents leaf = start_;
    for (std::size_t p = 0; p < sought_.size(); ++p) {
      const auto c = static_cast<std::size_t>(sought_[p]);
      const LeafContent& content = *each_[c].content;
      leaf.*content.value = std::clamp(content.low + parameters[static_cast<Eigen::Index>(p)] * range(c), content.low,
                                       content.usual_high);
    }
    return leaf;
  }

  detail::BoundedFit fitFrom(const LeafContents& start) const {
    const auto count = static_cast<Eigen::Index>(sought_.size());
    Eigen::VectorXd parameters(count);
    for (Eigen::Index p = 0; p < count; ++p) {
      const auto c = static_cast<std::size_t>(sought_[static_cast<std::size_t>(p)]);
      parameters[p] = (start.*each_[c].content->value - each_[c].content->low) / range(c);
    }
    std::vector<LeafSides> sides(model_.size());
    const auto evaluate = [&](const Eigen::VectorXd& at, bool slopes, detail::Residuals& result) {
      const LeafContents leaf = leafOf(at);
      model_.solve(leaf, sides);
      result.values.resize(static_cast<Eigen::Index>(data()));
      forData([&](Eigen::Index datum, std::size_t i, bool reflected, double value) {
        result.values[datum] = (reflected ? sides[i].reflectance : sides[i].transmittance) - value;
      });
      if (slopes) result.slopes = slopesAt(leaf)(Eigen::all, sought_);
    };
    return detail::fitWithin(parameters, Eigen::VectorXd::Zero(count), Eigen::VectorXd::Ones(count), evaluate);
  }

  ProspectFit told(const detail::BoundedFit& fit) {
    ProspectFit result{.contents = leafOf(fit.parameters), .iterations = fit.iterations, .converged = fit.converged};
    for (std::size_t p = 0; p < sought_.size(); ++p) {
      const auto c = static_cast<std::size_t>(sought_[p]);
      const auto i = static_cast<Eigen::Index>(p);
      each_[c].value = result.contents.*each_[c].content->value;
      const double error = std::sqrt(fit.variances[i]);  // in ranges; not a number where nothing tells it
      if (fit.at_bound[p])
        each_[c].state = State::at_limit;
      else if (!(error < 1.))
        each_[c].state = State::unseen;
      else
        each_[c].standard_error = error * range(c);
    }
    result.each = each_;
    std::vector<LeafSides> sides(model_.size());
    model_.solve(result.contents, sides);
    double squares[2] = {};
    forData([&](Eigen::Index, std::size_t i, bool reflected, double value) {
      squares[reflected ? 0 : 1] += std::pow((reflected ? sides[i].reflectance : sides[i].transmittance) - value, 2);
    });
    const auto rms = [](double sum, std::size_t count) { return std::sqrt(sum / static_cast<double>(count)); };
    result.rmse = rms(squares[0] + squares[1], data());
    if (!measured_.reflectance.empty()) result.rmse_reflectance = rms(squares[0], measured_.reflectance.size());
    if (!measured_.transmittance.empty()) result.rmse_transmittance = rms(squares[1], measured_.transmittance.size());
    return result;
  }

  const MeasuredSpectrum& measured_;
  Prospect model_;
  LeafContents start_;
  std::vector<FittedContent> each_;
  std::vector<Eigen::Index> sought_;  // those of `each_` that are to be found
};

}  // namespace

ProspectFit fitProspect(const MeasuredSpectrum& measured, const ProspectFitSettings& settings) {
  requireMeasured(measured);
  return Fitting(measured, settings).best();
}

}  // namespace sunfleck

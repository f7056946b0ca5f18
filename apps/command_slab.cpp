#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>
#include <sstream>

#include "apps/commands.hpp"
#include "core/require.hpp"
#include "spp/forward_share.hpp"
#include "spp/slab.hpp"

namespace sunfleck::apps {
namespace {

struct SlabOptions {
  std::string model = "spp";
  double albedo = 0.95;    // omega [1]
  double asymmetry = 0.;   // g [1]
  double thickness = 10.;  // [1]
  double mu0 = 1.;         // [1]
  std::vector<double> depths;
  std::string batch;
};

struct SlabResult {
  double reflectance, transmittance, direct;
};

struct Slab {
  double asymmetry, albedo, thickness, mu0;
  double forward_share = spp::forwardShare(asymmetry, mu0);

  spp::precise::SlabPowers at(double depth) const {
    return spp::precise::sppPowers(depth, thickness, mu0, albedo, forward_share);
  }
  // P+ and P- are powers relative to F = P+(0); the common factor mu0 of fluxes cancels.
  SlabResult result() const {
    return {.reflectance = at(0.).up,
            .transmittance = at(thickness).down,
            .direct = spp::precise::directPower(thickness, mu0)};
  }
};

void check(double value, const std::string& where, const std::string& name, bool ok, const std::string& rule) {
  require(ok, where + name, value, rule);
}

Slab checkedSlab(double asymmetry, double albedo, double thickness, double mu0, const std::string& where) {
  check(asymmetry, where, "g", asymmetry > -1. && asymmetry < 1., "in (-1, 1)");
  check(albedo, where, "omega", albedo >= 0. && albedo <= 1., "in [0, 1]");
  check(thickness, where, "thickness", thickness > 0., "above 0; inf is allowed");
  check(mu0, where, "mu0", mu0 > 0. && mu0 <= 1., "in (0, 1]");
  return {.asymmetry = asymmetry, .albedo = albedo, .thickness = thickness, .mu0 = mu0};
}

constexpr const char* kBatchHeader = "g,omega,thickness,mu0";

// One case a line; the answer of each is printed when all lines have been found right.
int runBatch(const std::string& file) {
  std::ifstream in(file);
  if (!in || !std::filesystem::is_regular_file(file)) throw InvalidInput(file + ": cannot be read");
  std::string line, output = std::string(kBatchHeader) + ",reflectance,transmittance,direct\n";
  std::getline(in, line);
  if (!line.empty() && line.back() == '\r') line.pop_back();
  if (line != kBatchHeader) throw InvalidInput(file + ":1: \"" + line.substr(0, 80) + "\": must be " + kBatchHeader);
  for (int number = 2; std::getline(in, line); ++number) {
    if (!line.empty() && line.back() == '\r') line.pop_back();
    if (line.empty()) continue;
    const std::string where = fmt::format("{}:{}: ", file, number);
    std::vector<double> values;
    std::istringstream fields(line);
    for (std::string field; std::getline(fields, field, ',');) {
      char* end = nullptr;
      values.push_back(std::strtod(field.c_str(), &end));
      if (field.empty() || *end != '\0') throw InvalidInput(where + "\"" + field + "\": must be a number");
    }
    if (values.size() != 4)
      throw InvalidInput(fmt::format("{}{} fields: must be 4, {}", where, values.size(), kBatchHeader));
    const SlabResult r = checkedSlab(values[0], values[1], values[2], values[3], where).result();
    output += fmt::format("{},{:.17g},{:.17g},{:.17g}\n", line, r.reflectance, r.transmittance, r.direct);
  }
  fmt::print("{}", output);
  return 0;
}

int runSlab(const SlabOptions& options, bool json) {
  if (!options.batch.empty()) return runBatch(options.batch);
  const Slab slab = checkedSlab(options.asymmetry, options.albedo, options.thickness, options.mu0, "");
  for (const double depth : options.depths)
    check(depth, "", "depth", depth >= 0. && depth <= options.thickness,
          fmt::format("in [0, {}], the thickness", options.thickness));
  const auto start = std::chrono::steady_clock::now();
  const SlabResult r = slab.result();
  struct Row {
    double depth, down, up, direct, radiance_down, radiance_up;
  };
  std::vector<Row> rows;
  for (const double depth : options.depths) {
    const auto powers = slab.at(depth);
    const double direct = spp::precise::directPower(depth, slab.mu0);
    const auto radiance = spp::precise::sppDiffuseRadiance(powers, direct);
    rows.push_back({depth, powers.down, powers.up, direct, radiance.down, radiance.up});
  }
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  if (json) {
    nlohmann::ordered_json radiance = nlohmann::ordered_json::array();
    for (const Row& row : rows)  // the model's radiance is the same for all directions of a half: one value for each
      for (const auto& [mu, value] : {std::pair{1., row.radiance_down}, std::pair{-1., row.radiance_up}})
        radiance.push_back({{"depth", row.depth}, {"mu", mu}, {"phi_deg", 0.}, {"value", value}});
    const nlohmann::ordered_json result{{"reflectance", r.reflectance},
                                        {"transmittance", r.transmittance},
                                        {"direct", r.direct},
                                        {"absorptance", std::max(0., 1. - r.reflectance - r.transmittance)},
                                        {"radiance", radiance},
                                        {"streams", 2},
                                        {"seconds", seconds}};
    fmt::print("{}\n", result.dump(2));
    return 0;
  }
  fmt::print("reflectance   {:.9f}\ntransmittance {:.9f}\n  direct      {:.9f}\nabsorptance   {:.9f}\n", r.reflectance,
             r.transmittance, r.direct, std::max(0., 1. - r.reflectance - r.transmittance));
  if (!rows.empty())
    fmt::print("\n{:>10} {:>12} {:>12} {:>12} {:>15} {:>15}\n", "depth", "P+", "P-", "direct", "radiance down",
               "radiance up");
  for (const Row& row : rows)
    fmt::print("{:10.4g} {:12.6f} {:12.6f} {:12.6f} {:15.6f} {:15.6f}\n", row.depth, row.down, row.up, row.direct,
               row.radiance_down, row.radiance_up);
  return 0;
}

// A number, infinity included: CLI11 takes an empty text for 0.
CLI::Validator number() {
  return CLI::Validator(
      [](const std::string& text) {
        double value = 0.;
        return !text.empty() && CLI::detail::lexical_cast(text, value) ? std::string()
                                                                       : "\"" + text + "\": must be a number";
      },
      "");
}

}  // namespace

void addSlab(CLI::App& app, RunOptions& options, int& status) {
  auto slab = std::make_shared<SlabOptions>();
  CLI::App* command = addCommand(app, options, "slab", "Solve one plane-parallel slab, or a file of them");
  command->add_option("--model", slab->model, "spp: the simplified plane-parallel model (default)")
      ->check(CLI::IsMember({"spp"}));
  command->add_option("--omega", slab->albedo, "Single-scattering albedo, 0 to 1 (default 0.95)")->check(number());
  command
      ->add_option("--g", slab->asymmetry, "Asymmetry of Henyey-Greenstein scattering, above -1, below 1 (default 0)")
      ->check(number());
  command->add_option("--thickness", slab->thickness, "Optical thickness, above 0; inf for a half space (default 10)")
      ->check(number());
  command->add_option("--mu0", slab->mu0, "|cos| of the beam to the slab's normal, above 0, at most 1 (default 1)")
      ->check(number());
  command->add_option("--depths", slab->depths, "Optical depths to print the light at, such as 0,1,5")
      ->delimiter(',')
      ->check(number());
  command->add_option("--batch", slab->batch,
                      "CSV with columns g,omega,thickness,mu0, written back with reflectance,transmittance,direct");
  command->callback([slab, &options, &status] { status = runSlab(*slab, options.json); });
}

}  // namespace sunfleck::apps

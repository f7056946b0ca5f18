#include "apps/leaf_output.hpp"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "leaves/light_bands.hpp"
#include "render/compare/spectrum_plot.hpp"

namespace sunfleck::apps {
namespace {

using Json = nlohmann::ordered_json;
using State = FittedContent::State;

struct NamedBand {
  const char* name;
  WavelengthBand band;
};
constexpr NamedBand kBroadBands[] = {
    {"visible", {400., 700.}}, {"near infrared", {700., 1300.}}, {"short-wave infrared", {1300., 2500.}}};
constexpr const char* kColours[] = {"red", "green", "blue"};

// The contents that this kind of leaf has: dry matter, or its parts.
std::vector<const LeafContent*> contentsOf(const LeafContents& leaf) {
  const bool parts = leaf.protein > 0. || leaf.carbon_constituents > 0.;
  std::vector<const LeafContent*> contents;
  for (const LeafContent& content : leafContents()) {
    const bool part = content.name == "protein" || content.name == "carbon_constituents";
    if (parts ? content.name != "dry_matter" : !part) contents.push_back(&content);
  }
  return contents;
}

std::string bandName(const WavelengthBand& band) {
  return band.low == band.high ? fmt::format("{:g} nm", band.low) : fmt::format("{:g} to {:g} nm", band.low, band.high);
}

std::string row(const std::string& name, const LeafSides& sides) {
  return fmt::format("  {:<36} {:11.4f} {:13.4f} {:11.4f}\n", name, sides.reflectance, sides.transmittance,
                     1. - sides.reflectance - sides.transmittance);
}

std::string stateText(const FittedContent& each) {
  switch (each.state) {
    case State::found:
      return fmt::format("+- {:.2g}", each.standard_error);
    case State::at_limit:
      return "at its limit";
    case State::unseen:
      return "not seen by these data";
    case State::held:
      return "held";
  }
  return "";
}

std::string fitText(const LeafReport& leaf) {
  const ProspectFit& fit = *leaf.fit;
  std::string text = fmt::format(
      "\nNearest leaf of PROSPECT to {} values at {} wavelengths{}\n",
      leaf.measured.reflectance.size() + leaf.measured.transmittance.size(), leaf.measured.wavelengths.size(),
      leaf.left_out > 0 ? fmt::format("; {} outside of 400 to 2500 nm left out", leaf.left_out) : "");
  text += fmt::format("  root mean square of what remains: {:.3g}", fit.rmse);
  if (fit.rmse_reflectance && fit.rmse_transmittance)
    text += fmt::format(" (reflectance {:.3g}, transmittance {:.3g})", *fit.rmse_reflectance, *fit.rmse_transmittance);
  text += fmt::format("; {} steps{}\n", fit.iterations, fit.converged ? "" : ", not at an end");
  return text;
}

std::string measuredText(const LeafReport& leaf) {
  std::string text =
      fmt::format("\n  {:<36} {:>11} {:>13}\n", "Measured, and the model there", "reflectance", "transmittance");
  for (std::size_t i = 0; i < leaf.species->bands.size(); ++i) {
    const LeafSides &found = leaf.species->measured[i], model = meanIn(leaf.spectrum, leaf.species->bands[i]);
    text += fmt::format("  {:<29}{:7.4f} {:10.4f} {:6.4f} {:6.4f}\n", bandName(leaf.species->bands[i]),
                        found.reflectance, model.reflectance, found.transmittance, model.transmittance);
  }
  text += fmt::format("  root mean square of the difference over 420 to 2400 nm: {:.4f}\n  source: {}\n",
                      leaf.species->fit_rmse, leaf.species->source);
  if (!leaf.species->caveat.empty()) text += fmt::format("  caveat: {}\n", leaf.species->caveat);
  return text;
}

Json sharesJson(const LeafSides& sides) {
  return {{"reflectance", sides.reflectance}, {"transmittance", sides.transmittance}};
}
Json bandJson(const WavelengthBand& band, const LeafSides& sides) {
  Json json{{"from_nm", band.low}, {"to_nm", band.high}};
  json.update(sharesJson(sides));
  return json;
}

Json fitJson(const LeafReport& leaf) {
  const ProspectFit& fit = *leaf.fit;
  Json json{{"rmse", fit.rmse}};
  if (fit.rmse_reflectance) json["rmse_reflectance"] = *fit.rmse_reflectance;
  if (fit.rmse_transmittance) json["rmse_transmittance"] = *fit.rmse_transmittance;
  json["iterations"] = fit.iterations;
  json["converged"] = fit.converged;
  json["rows_left_out"] = leaf.left_out;
  for (const FittedContent& each : fit.each) {
    Json content{{"value", each.value}};
    if (each.state == State::found)
      content["standard_error"] = each.standard_error;
    else
      content["state"] = each.state == State::at_limit ? "at_limit" : each.state == State::unseen ? "unseen" : "held";
    json["contents"][std::string(each.content->name)] = std::move(content);
  }
  return json;
}

SpectrumCurve dots(const MeasuredSpectrum& measured, const std::vector<double>& values, const char* label,
                   const char* colour) {
  SpectrumCurve curve{.label = label, .colour = colour, .joined = false, .points = {}};
  for (std::size_t i = 0; i < values.size(); ++i) curve.points.emplace_back(measured.wavelengths[i], values[i]);
  return curve;
}

}  // namespace

std::string leafText(const LeafReport& leaf) {
  std::string text = leaf.title + "\n";
  if (leaf.fit) text += fitText(leaf);
  text += "\n";
  for (const LeafContent* content : contentsOf(leaf.contents)) {
    std::string how;
    if (leaf.fit)
      for (const FittedContent& each : leaf.fit->each)
        if (each.content == content) how = stateText(each);
    text += fmt::format("  {:<20} {:<6} {:>10.5g} {:<8} {}", content->name, content->symbol,
                        leaf.contents.*content->value, content->unit, how);
    text.erase(text.find_last_not_of(' ') + 1);
    text += "\n";
  }
  text += fmt::format("\n  {:<36} {:>11} {:>13} {:>11}\n", "Light", "reflectance", "transmittance", "absorptance");
  const auto rgb = rgbOf(leaf.spectrum);
  for (std::size_t band = 0; band < kBands; ++band)
    text += row(fmt::format("{} of the eye (sRGB, D65)", kColours[band]), rgb[band]);
  for (const auto& [name, band] : kBroadBands)
    text += row(fmt::format("{}, {}", name, bandName(band)), meanIn(leaf.spectrum, band));
  for (const WavelengthBand& band : leaf.bands) text += row(bandName(band), meanIn(leaf.spectrum, band));
  if (leaf.species) text += measuredText(leaf);
  return text;
}

std::string leafJson(const LeafReport& leaf) {
  Json json{{"title", leaf.title}};
  for (const LeafContent* content : contentsOf(leaf.contents))
    json["contents"][std::string(content->name)] = leaf.contents.*content->value;
  const auto rgb = rgbOf(leaf.spectrum);
  for (std::size_t band = 0; band < kBands; ++band) json["rgb"][kColours[band]] = sharesJson(rgb[band]);
  json["bands"] = Json::array();
  for (const auto& [name, band] : kBroadBands) {
    json["bands"].push_back({{"name", name}});
    json["bands"].back().update(bandJson(band, meanIn(leaf.spectrum, band)));
  }
  for (const WavelengthBand& band : leaf.bands) json["bands"].push_back(bandJson(band, meanIn(leaf.spectrum, band)));
  if (leaf.species) {
    Json& species = json["species"] = {{"name", leaf.species->name},
                                       {"source", leaf.species->source},
                                       {"caveat", leaf.species->caveat},
                                       {"fit_rmse", leaf.species->fit_rmse},
                                       {"measured", Json::array()}};
    for (std::size_t i = 0; i < leaf.species->bands.size(); ++i)
      species["measured"].push_back(bandJson(leaf.species->bands[i], leaf.species->measured[i]));
  }
  if (leaf.fit) json["fit"] = fitJson(leaf);
  Json wavelengths = Json::array(), reflectance = Json::array(), transmittance = Json::array();
  for (std::size_t i = 0; i < leaf.spectrum.sides.size(); ++i) {
    wavelengths.push_back(kFirstWavelength + static_cast<int>(i));
    reflectance.push_back(leaf.spectrum.sides[i].reflectance);
    transmittance.push_back(leaf.spectrum.sides[i].transmittance);
  }
  json["spectrum"] = {{"wavelength_nm", wavelengths}, {"reflectance", reflectance}, {"transmittance", transmittance}};
  return json.dump(2) + "\n";
}

std::string leafPlot(const LeafReport& leaf) {
  constexpr const char *kReflected = "#1b7837", *kTransmitted = "#2166ac", *kAbsorbed = "#b35806";
  SpectrumCurve reflected{.label = "reflected", .colour = kReflected, .points = {}},
      transmitted{.label = "let through", .colour = kTransmitted, .points = {}},
      absorbed{.label = "absorbed", .colour = kAbsorbed, .points = {}};
  for (std::size_t i = 0; i < leaf.spectrum.sides.size(); ++i) {
    const double wavelength = kFirstWavelength + static_cast<double>(i);
    const LeafSides& sides = leaf.spectrum.sides[i];
    reflected.points.emplace_back(wavelength, sides.reflectance);
    transmitted.points.emplace_back(wavelength, sides.transmittance);
    absorbed.points.emplace_back(wavelength, 1. - sides.reflectance - sides.transmittance);
  }
  std::string subtitle;
  for (const LeafContent* content : contentsOf(leaf.contents))
    subtitle += fmt::format("{}{} {:.4g}{}{}", subtitle.empty() ? "" : ", ", content->symbol,
                            leaf.contents.*content->value, content->unit.empty() ? "" : " ", content->unit);
  std::vector<SpectrumCurve> curves{std::move(reflected), std::move(transmitted), std::move(absorbed)};
  if (leaf.fit) {
    if (!leaf.measured.reflectance.empty())
      curves.push_back(dots(leaf.measured, leaf.measured.reflectance, "measured reflectance", kReflected));
    if (!leaf.measured.transmittance.empty())
      curves.push_back(dots(leaf.measured, leaf.measured.transmittance, "measured transmittance", kTransmitted));
  }
  const auto rgb = rgbOf(leaf.spectrum);
  return spectrumPlot(leaf.title, subtitle, curves,
                      {{"colour by reflected light", {rgb[0].reflectance, rgb[1].reflectance, rgb[2].reflectance}},
                       {"by light let through", {rgb[0].transmittance, rgb[1].transmittance, rgb[2].transmittance}}});
}

std::string leafCsv(const LeafSpectrum& spectrum) {
  std::string text = "wavelength_nm,reflectance,transmittance\n";
  for (std::size_t i = 0; i < spectrum.sides.size(); ++i)
    text += fmt::format("{},{:.8f},{:.8f}\n", kFirstWavelength + static_cast<int>(i), spectrum.sides[i].reflectance,
                        spectrum.sides[i].transmittance);
  return text;
}

std::string bandsCsv(const LeafReport& leaf) {
  std::string text = "name,leaf_reflectance,leaf_transmittance\n";
  for (const WavelengthBand& band : leaf.bands) {
    const LeafOptics optics = leafOptics(meanIn(leaf.spectrum, band));
    text += fmt::format("{},{},{}\n", bandName(band), optics.reflectance, optics.transmittance);
  }
  return text;
}

}  // namespace sunfleck::apps

#pragma once

#include <span>
#include <string>
#include <string_view>
#include <utility>

namespace sunfleck {

// What a leaf is made of, as PROSPECT-D and PROSPECT-PRO have it. Left as it is, the leaf of the reference values.
struct LeafContents {
  double structure = 1.5;           // N [1], 1 .. 10: layers that the leaf seems to consist of
  double chlorophyll = 40.;         // Cab [ug/cm^2], 0 .. 1000
  double carotenoids = 8.;          // Car [ug/cm^2], 0 .. 1000
  double anthocyanins = 0.;         // Ant [ug/cm^2], 0 .. 1000
  double brown_pigments = 0.;       // Brown [1], 0 .. 100
  double water = 0.01;              // Cw, equivalent thickness [cm], 0 .. 10
  double dry_matter = 0.009;        // Cm [g/cm^2], 0 .. 10; 0 where the next two tell it (PROSPECT-PRO)
  double protein = 0.;              // Cp [g/cm^2], 0 .. 10
  double carbon_constituents = 0.;  // CBC [g/cm^2], 0 .. 10: cellulose, lignin, starch, sugars
  bool operator==(const LeafContents&) const = default;
};

// One of them, for files, command lines and people.
struct LeafContent {
  std::string_view name;    // as files have it
  std::string_view symbol;  // as papers have it
  std::string_view unit;    // empty: a plain number
  double LeafContents::*value;
  double low, high;   // its range
  double usual_high;  // the largest that is sought for a measured spectrum
};
std::span<const LeafContent> leafContents();

// The content of that name. Throws InvalidInput that lists the names, with `where` before it.
const LeafContent& leafContent(std::string_view name, const std::string& where = "");

// Sets contents by name and value. Protein or carbon-based constituents take the place of dry matter unless it is
// named, too, and the other way round. Throws InvalidInput, with `where` before its message, on a name that is unknown
// or there twice, and as validate() does.
void setContents(LeafContents& leaf, std::span<const std::pair<std::string, double>> values, const std::string& where);

// Throws InvalidInput("<where><name> = <value>: must be ...") where a content is out of its range, and on dry matter
// beside protein or carbon-based constituents, which are that dry matter.
void validate(const LeafContents& leaf, const std::string& where = "");

}  // namespace sunfleck

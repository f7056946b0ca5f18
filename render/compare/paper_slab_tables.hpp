#pragma once

#include <array>
#include <limits>

// Tables 1 and 2 of Shinya, Dobashi, Iwasaki, Shiraishi, Nishita 2013, "A Simplified Plane-parallel Scattering Model
// for Rendering Densely Distributed Objects such as Foliage", as printed: RMS errors [%] of the simplified solution and
// of the refined one, Henyey-Greenstein scatterers.
namespace sunfleck::paper {

inline constexpr std::array<double, 5> kAlbedos{0.5, 0.7, 0.9, 0.95, 0.99};

// Table 1: thickness 10. The last entry is the table's row "total".
struct Table1Column {
  double asymmetry;
  std::array<double, 6> simplified, refined;
};
inline constexpr double kTable1Thickness = 10.;
inline constexpr std::array<Table1Column, 3> kTable1{
    Table1Column{0., {2.7, 1.9, 2.1, 2.9, 4.5, 2.8}, {0.3, 0.5, 1.2, 1.7, 3.9, 1.7}},
    Table1Column{0.5, {1.3, 2.1, 3.4, 4.1, 5.5, 3.3}, {0.3, 0.7, 1.7, 2.7, 5.8, 2.5}},
    Table1Column{-0.5, {1.2, 1.8, 2.7, 3.4, 5.0, 2.9}, {0.2, 0.4, 1.3, 2.0, 4.7, 2.1}},
};

// Table 2: "other conditions are the same as Table 1"; which g it is for is not printed. Its column for thickness 10
// lies among the refined columns of Table 1. The last entry is the row "total".
struct Table2Column {
  double thickness;
  std::array<double, 6> refined;
};
inline constexpr std::array<Table2Column, 4> kTable2{
    Table2Column{std::numeric_limits<double>::infinity(), {0.3, 0.7, 1.7, 2.3, 4.0, 2.3}},
    Table2Column{16., {0.3, 0.7, 1.7, 2.2, 4.6, 2.5}},
    Table2Column{10., {0.3, 0.7, 1.6, 2.1, 4.6, 2.4}},
    Table2Column{5., {0.4, 0.8, 1.6, 2.6, 4.4, 2.5}},
};

}  // namespace sunfleck::paper

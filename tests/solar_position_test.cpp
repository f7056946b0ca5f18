#include "sky/solar_position.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "core/require.hpp"

using namespace sunfleck;

namespace {

constexpr double kDegree = std::numbers::pi / 180.;

struct Place {
  const char *date, *time;
  double latitude, longitude;  // [degree]
  double zenith, from_north;   // [degree], the azimuth clockwise from north
};

// Angle between the two directions to the sun [degree].
double apart(const SolarPosition& found, double zenith, double azimuth) {
  const double cosine = std::cos(found.zenith) * std::cos(zenith) +
                        std::sin(found.zenith) * std::sin(zenith) * std::cos(found.azimuth - azimuth);
  return std::acos(std::min(1., cosine)) / kDegree;
}

SolarPosition at(const Place& place) {
  return solarPosition(utcMoment(place.date, place.time), place.latitude * kDegree, place.longitude * kDegree);
}

}  // namespace

// Check published positions: the example of NREL's Solar Position Algorithm (Reda & Andreas 2008, Table A5.1: zenith
// 50.11162 with a refraction of 0.01633, azimuth 194.34024) and others by PyEphem 4 (VSOP87) without air, on both
// hemispheres, beyond the polar circle, by night and near overhead, in 1950 to 2050. 0.01 degrees is what Meeus states
// of the formulas.
TEST(R29_SolarPosition, MatchesPublishedPositions) {
  const std::vector<Place> places{{"2003-10-17", "12:30:30-07:00", 39.742476, -105.1786, 50.11162 + 0.01633, 194.34024},
                                  {"1992-10-13", "11:46:17", 0., 0., 7.96754, 180.19210},
                                  {"2000-03-20", "07:35", 0., 66.25, 1.85828, 89.99979},
                                  {"2000-06-21", "01:48Z", 23.4393, 150., 3.14793, 89.34396},
                                  {"2024-12-21", "20:20:00+11:00", -35., 149.1, 91.33387, 239.86868},
                                  {"2026-11-23", "15:00:00.0", 35.68, 139.77, 163.14780, 27.32235},
                                  {"1950-07-04", "12:00:00", 51.4779, 0., 28.57822, 177.98888},
                                  {"2050-02-01", "06:30:00", -22.9, -43.2, 116.18527, 124.18675},
                                  {"2012-06-20", "23:59:59", 69.65, 18.96, 85.96820, 16.98206},
                                  {"2020-03-20", "12:00:00", 0., 0., 1.83905, 85.80153}};
  for (const Place& place : places) {
    const SolarPosition found = at(place);
    EXPECT_LT(apart(found, place.zenith * kDegree, (90. - place.from_north) * kDegree), 0.01)
        << place.date << " " << place.time << ": zenith " << found.zenith / kDegree << ", azimuth from north "
        << 90. - found.azimuth / kDegree;
    EXPECT_NEAR(found.zenith / kDegree, place.zenith, 0.01);
  }
}

// Check the seasons as the poles see them: at the equinox (2000-03-20 07:35 UTC) the sun is on the horizon, at the
// solstices (2000-06-21 01:48 and 2000-12-21 13:37) as high or low as the Earth's axis leans, 23.439 degrees; Meeus's
// example 25.a, 1992-10-13: declination -7.78507. Parallax lowers it by 0.0024.
TEST(R29_SolarPosition, KnowsTheSeasons) {
  const auto height = [](const char* date, const char* time, double latitude) {
    return 90. - at({date, time, latitude, 0., 0., 0.}).zenith / kDegree;
  };
  EXPECT_NEAR(height("2000-03-20", "07:35", 90.), -0.0024, 0.01);
  EXPECT_NEAR(height("2000-06-21", "01:48", 90.), 23.439 - 0.0022, 0.01);
  EXPECT_NEAR(height("2000-06-21", "01:48", -90.), -23.439 - 0.0022, 0.01);
  EXPECT_NEAR(height("2000-12-21", "13:37", -90.), 23.439 - 0.0022, 0.01);
  EXPECT_NEAR(height("1992-10-13", "00:00", 90.), -7.78507 - 0.0024, 0.01);
}

// Check that the sun rises in the east and sets in the west, over the north from the southern hemisphere, and that
// nothing but finite numbers comes out at the poles.
TEST(R29_SolarPosition, GoesFromEastToWest) {
  EXPECT_GT(std::cos(at({"2021-09-22", "06:30", 40., 0., 0., 0.}).azimuth), 0.9);  // +x is east
  EXPECT_LT(std::cos(at({"2021-09-22", "17:30", 40., 0., 0., 0.}).azimuth), -0.9);
  EXPECT_LT(std::sin(at({"2021-09-22", "12:00", 40., 0., 0., 0.}).azimuth), -0.99);  // +y is north
  EXPECT_GT(std::sin(at({"2021-09-22", "12:00", -40., 0., 0., 0.}).azimuth), 0.99);
  for (const double latitude : {-90., 90.}) {
    const SolarPosition pole = at({"2021-09-22", "12:00", latitude, 0., 0., 0.});
    EXPECT_TRUE(std::isfinite(pole.zenith) && std::isfinite(pole.azimuth));
  }
}

// Check how moments are read: zones, also over midnight, the new year and leap days; and what is refused.
TEST(R29_SolarPosition, ReadsMoments) {
  const auto is = [](const UtcMoment& moment, int year, int month, int day, double hours) {
    EXPECT_EQ(moment.year, year);
    EXPECT_EQ(moment.month, month);
    EXPECT_EQ(moment.day, day);
    EXPECT_NEAR(moment.hours, hours, 1e-12);
  };
  is(utcMoment("2003-10-17", "12:30:30-07:00"), 2003, 10, 17, 19.5 + 30. / 3600.);
  is(utcMoment("2003-12-31", "23:15-01:00"), 2004, 1, 1, 0.25);
  is(utcMoment("2004-01-01", "00:15+01:30"), 2003, 12, 31, 22.75);
  is(utcMoment("2004-02-28", "23:00:00.5-02:00"), 2004, 2, 29, 1. + 0.5 / 3600.);
  is(utcMoment("2100-02-28", "23:00:00-02:00"), 2100, 3, 1, 1.);
  for (const char* date :
       {"", "2003-10", "2003-13-01", "2003-02-29", "1899-12-31", "2003-1-17", "2003-10-17x", "17.10.2003"})
    EXPECT_THROW(utcMoment(date, "12:00"), InvalidInput) << date;
  for (const char* time : {"", "12", "24:00", "12:60", "12:30:60", "12:30:3", "12:30:30.5.1", "12:30-7", "12:30-07:00x",
                           "12:30+15:00", "12:30:30 ", "nan", "12:30:1e1"})
    EXPECT_THROW(utcMoment("2003-10-17", time), InvalidInput) << time;
  try {
    utcMoment("2003-10-17", "noon", "s.toml: sun.");
    FAIL();
  } catch (const InvalidInput& e) {
    EXPECT_STREQ(e.what(),
                 "s.toml: sun.time = \"noon\": must be a time of day, in UTC or with its zone's offset, as in 12:30, "
                 "12:30:30Z or 12:30:30-07:00");
  }
}

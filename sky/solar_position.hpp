#pragma once

#include <string>

namespace sunfleck {

// A moment in universal time, UTC.
struct UtcMoment {
  int year = 2000, month = 1, day = 1;  // Gregorian; kFirstYear .. kLastYear
  double hours = 0.;                    // since midnight [h], 0 .. 24
};
inline constexpr int kFirstYear = 1900, kLastYear = 2100;

// Reads a date "2003-10-17" and a time of day, "12:30", "12:30:30" or "12:30:30.5", in UTC or with the offset of its
// zone behind it: "Z", "-07:00" or "+05:30". Throws InvalidInput, "<where>date = <text>: must be ...", on anything else
// and on days that are in no calendar.
UtcMoment utcMoment(const std::string& date, const std::string& time, const std::string& where = "");

// Where the sun stands in the sky of a place, x towards east and y towards north.
struct SolarPosition {
  double zenith = 0.;   // from overhead, of the disc's middle, as it would be seen without air [rad], 0 .. pi
  double azimuth = 0.;  // from +x, east, towards +y, north [rad], -pi .. pi
};

// (R29) The position to 0.01 degrees, without refraction, which lifts the sun by half a degree at the horizon and by
// 0.02 at a height of 40.
//   latitude   to the north [rad], -pi/2 .. pi/2
//   longitude  to the east [rad]
SolarPosition solarPosition(const UtcMoment& moment, double latitude, double longitude);

}  // namespace sunfleck

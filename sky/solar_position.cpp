#include "sky/solar_position.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <numbers>
#include <string_view>

#include "core/require.hpp"

namespace sunfleck {
namespace {

constexpr double kDegree = std::numbers::pi / 180.;

// Takes a number of so many digits and what must stand behind it from the front of the text.
bool take(std::string_view& text, std::size_t digits, int& value, char behind = '\0') {
  if (text.size() < digits || !std::ranges::all_of(text.substr(0, digits), [](char c) { return c >= '0' && c <= '9'; }))
    return false;
  std::from_chars(text.data(), text.data() + digits, value);
  text.remove_prefix(digits);
  if (behind == '\0') return true;
  if (text.empty() || text.front() != behind) return false;
  text.remove_prefix(1);
  return true;
}

int daysOf(int year, int month) {
  constexpr std::array kDays{31, 28, 31, 30, 31, 30, 31, 31, 30, 31, 30, 31};
  const bool leap = year % 4 == 0 && (year % 100 != 0 || year % 400 == 0);
  return kDays[static_cast<std::size_t>(month - 1)] + (month == 2 && leap ? 1 : 0);
}

bool readDate(std::string_view text, UtcMoment& moment) {
  return take(text, 4, moment.year, '-') && take(text, 2, moment.month, '-') && take(text, 2, moment.day) &&
         text.empty() && moment.year >= kFirstYear && moment.year <= kLastYear && moment.month >= 1 &&
         moment.month <= 12 && moment.day >= 1 && moment.day <= daysOf(moment.year, moment.month);
}

// Offset of a zone [h].
bool readZone(std::string_view text, double& offset) {
  if (text.empty() || text == "Z" || text == "z") return true;
  const double sign = text.front() == '-' ? -1. : 1.;
  if (text.front() != '-' && text.front() != '+') return false;
  text.remove_prefix(1);
  int hours = 0, minutes = 0;
  if (!take(text, 2, hours, ':') || !take(text, 2, minutes) || !text.empty() || hours > 14 || minutes > 59)
    return false;
  offset = sign * (hours + minutes / 60.);
  return true;
}

bool readTime(std::string_view text, double& hours_utc) {
  int hours = 0, minutes = 0;
  double seconds = 0., offset = 0.;
  if (!take(text, 2, hours, ':') || !take(text, 2, minutes) || hours > 23 || minutes > 59) return false;
  if (!text.empty() && text.front() == ':') {
    text.remove_prefix(1);
    const std::size_t length = std::min(text.find_first_not_of("0123456789."), text.size());
    if (length < 2 || text[0] == '.' || text[1] == '.' || (length > 2 && text[2] != '.')) return false;
    const auto [end, failure] = std::from_chars(text.data(), text.data() + length, seconds);
    if (failure != std::errc() || end != text.data() + length || !(seconds < 60.)) return false;
    text.remove_prefix(length);
  }
  if (!readZone(text, offset)) return false;
  hours_utc = hours + minutes / 60. + seconds / 3600. - offset;
  return true;
}

// By so many days, one or none.
void moveDay(UtcMoment& moment, int by) {
  moment.day += by;
  if (moment.day < 1) {
    moment.month = moment.month == 1 ? 12 : moment.month - 1;
    if (moment.month == 12) --moment.year;
    moment.day = daysOf(moment.year, moment.month);
  } else if (moment.day > daysOf(moment.year, moment.month)) {
    moment.month = moment.month == 12 ? 1 : moment.month + 1;
    if (moment.month == 1) ++moment.year;
    moment.day = 1;
  }
}

// Days since the noon that began the year 2000; Meeus 1998, Eq. 7.1.
double daysSince2000(const UtcMoment& moment) {
  const int year = moment.month <= 2 ? moment.year - 1 : moment.year;
  const int month = moment.month <= 2 ? moment.month + 12 : moment.month;
  const int century = year / 100;
  const double midnight = std::floor(365.25 * (year + 4716)) + std::floor(30.6001 * (month + 1)) + moment.day + 2 -
                          century + century / 4 - 1524.5;
  return midnight - 2451545. + moment.hours / 24.;
}

}  // namespace

UtcMoment utcMoment(const std::string& date, const std::string& time, const std::string& where) {
  UtcMoment moment;
  if (!readDate(date, moment))
    throw InvalidInput(where + "date = \"" + date + "\": must be a day from 1900 to 2100, as in 2003-10-17");
  if (!readTime(time, moment.hours))
    throw InvalidInput(where + "time = \"" + time +
                       "\": must be a time of day, in UTC or with its zone's offset, as in 12:30, 12:30:30Z or "
                       "12:30:30-07:00");
  const int by = moment.hours < 0. ? -1 : moment.hours >= 24. ? 1 : 0;
  moment.hours -= 24. * by;
  moveDay(moment, by);
  return moment;
}

// Meeus 1998, chapters 12, 13, 22 and 25. Universal time stands for dynamical time, of which it is a minute or two off:
// the sun moves 0.0007 degrees in a minute.
SolarPosition solarPosition(const UtcMoment& moment, double latitude, double longitude) {
  const double days = daysSince2000(moment), t = days / 36525.;  // [Julian century]
  const double anomaly = (357.52911 + t * (35999.05029 - 0.0001537 * t)) * kDegree;
  const double centre = (1.914602 - t * (0.004817 + 0.000014 * t)) * std::sin(anomaly) +
                        (0.019993 - 0.000101 * t) * std::sin(2. * anomaly) + 0.000289 * std::sin(3. * anomaly);
  const double node = (125.04 - 1934.136 * t) * kDegree;  // of the moon's path, for nutation
  const double apparent_longitude =
      (280.46646 + t * (36000.76983 + 0.0003032 * t) + centre - 0.00569 - 0.00478 * std::sin(node)) * kDegree;
  const double obliquity = (23.439291 - 0.0130042 * t + 0.00256 * std::cos(node)) * kDegree;
  const double right_ascension =
      std::atan2(std::cos(obliquity) * std::sin(apparent_longitude), std::cos(apparent_longitude));
  const double declination = std::asin(std::sin(obliquity) * std::sin(apparent_longitude));
  const double sidereal = (280.46061837 + 360.98564736629 * days - 0.00478 * std::sin(node) * std::cos(obliquity)) *
                          kDegree;  // at Greenwich, apparent
  const double hour_angle = sidereal + longitude - right_ascension;

  // To the sun: towards east, north and up.
  const double east = -std::cos(declination) * std::sin(hour_angle);
  const double north =
      std::cos(latitude) * std::sin(declination) - std::sin(latitude) * std::cos(declination) * std::cos(hour_angle);
  const double up =
      std::sin(latitude) * std::sin(declination) + std::cos(latitude) * std::cos(declination) * std::cos(hour_angle);
  const double across = std::hypot(east, north);
  constexpr double kParallax =
      8.794 / 3600. * kDegree;  // seen from the ground the sun stands lower than from the middle
  return {.zenith = std::atan2(across, up) + kParallax * across, .azimuth = across > 0. ? std::atan2(north, east) : 0.};
}

}  // namespace sunfleck

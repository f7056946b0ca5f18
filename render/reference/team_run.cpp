#include "render/reference/team_run.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <numeric>

#include "core/elapsed.hpp"
#include "core/require.hpp"
#include "render/reference/trace_file.hpp"

namespace sunfleck {
namespace {

using Json = nlohmann::json;

// The first round is short, as nobody knows yet how fast the ranks are; the last are long enough for the exchange of
// sums not to matter.
constexpr double kFirstSeconds = 0.1, kMostSeconds = 3.;
// Units beyond what a rank is likely to do in a round, so that it does not idle when it turns out faster.
constexpr double kSpare = 1.25;

UnitRanges unitsIn(const Json& ranges) {
  UnitRanges units;
  for (const auto& [first, last] : ranges.get<std::vector<UnitRanges::Range>>()) units.add(first, last);
  return units;
}

// `count` of the units, after leaving out the first `skipped`.
UnitRanges slice(const UnitRanges& units, std::uint64_t skipped, std::uint64_t count) {
  UnitRanges result;
  for (auto [first, last] : units.ranges()) {
    const std::uint64_t left_out = std::min(skipped, last - first);
    skipped -= left_out;
    first += left_out;
    const std::uint64_t taken = std::min(count, last - first);
    result.add(first, first + taken);
    count -= taken;
  }
  return result;
}

// What every rank does in a round: its share of the units, told to rank 0. The lead's reports, nothing elsewhere.
std::vector<std::string> computeShare(TraceTeam& team, const TraceJob& job, TraceUnits units, TraceSums& found,
                                      const Progress& progress) {
  bool go_on = true;
  const Elapsed elapsed;
  runUnits(job, units, found, [&](double done) { return go_on = goOn(progress, done) && go_on; });
  // A rank without units must hear of Ctrl-C, too.
  go_on = go_on && goOn(progress, 1.);
  std::vector<std::string> reports = team.toFirst(
      Json{{"done", found.done(units.seed).ranges()}, {"seconds", elapsed.seconds()}, {"go_on", go_on}}.dump());
  team.sumToFirst(found.values());
  return reports;
}

}  // namespace

void requireSameAtAll(TraceTeam& team, const TraceIdentity& identity) {
  const auto first = Json::parse(team.fromFirst(Json(identity).dump())).get<TraceIdentity>();
  requireSame("this rank", identity, first);
}

TeamLead::TeamLead(TraceTeam& team, const TraceJob& job, std::uint64_t seed, int threads)
    : team_(team),
      job_(job),
      seed_(seed),
      threads_(threads),
      seconds_(kFirstSeconds),
      speed_(static_cast<std::size_t>(team.size())) {
  requireSameAtAll(team, job.identity());
}

// Tells all what each does of the missing, lowest units first; answers this rank's.
UnitRanges TeamLead::deal(const UnitRanges& missing, std::uint64_t& dealt) {
  const std::uint64_t count = missing.count();
  const double all = std::accumulate(speed_.begin(), speed_.end(), 0.);
  const bool known = std::all_of(speed_.begin(), speed_.end(), [](double speed) { return speed > 0.; });
  dealt = 0;
  std::vector<std::uint64_t> shares;
  for (const double speed : speed_) {
    const double fair = static_cast<double>(count) * (known ? speed / all : 1. / static_cast<double>(team_.size()));
    const double share = known ? std::min(fair, kSpare * speed * seconds_) : fair;
    shares.push_back(std::min(count - dealt, static_cast<std::uint64_t>(std::ceil(share))));
    dealt += shares.back();
  }
  team_.fromFirst(Json{{"seconds", seconds_}, {"shares", shares}, {"units", missing.ranges()}}.dump());
  return slice(missing, 0, shares.front());
}

bool TeamLead::work(const UnitRanges& wanted, TraceSums& sums, const Progress& during, const Progress& between) {
  const auto all = static_cast<double>(wanted.count());
  for (;;) {
    const UnitRanges missing = wanted.without(sums.done(seed_));
    const std::uint64_t left = missing.count();
    if (left == 0) return true;
    std::uint64_t dealt = 0;
    const UnitRanges own = deal(missing, dealt);
    const double before = all - static_cast<double>(left);

    TraceSums found(job_.bins(), job_.groups());
    // The others are likely to be as far as this rank.
    const Progress share = [&](double done) {
      return goOn(during, (before + done * static_cast<double>(dealt)) / all);
    };
    const std::vector<std::string> reports = computeShare(
        team_, job_, {.seed = seed_, .wanted = own, .threads = threads_, .seconds = seconds_}, found, share);
    bool go_on = true;
    UnitRanges done;
    for (std::size_t rank = 0; rank < reports.size(); ++rank) {
      const Json report = Json::parse(reports[rank]);
      const UnitRanges units = unitsIn(report.at("done"));
      for (const auto& [first, last] : units.ranges()) done.add(first, last);
      const auto seconds = report.at("seconds").get<double>();
      if (units.count() > 0 && seconds > 0.) speed_[rank] = static_cast<double>(units.count()) / seconds;
      go_on = go_on && report.at("go_on").get<bool>();
    }
    const std::uint64_t count = done.count();
    found.restore(seed_, std::move(done));
    sums.add(found);
    seconds_ = std::min(2. * seconds_, kMostSeconds);
    if (!goOn(between, (before + static_cast<double>(count)) / all) || !go_on) return false;
  }
}

void TeamLead::end(bool go_on) {
  team_.fromFirst(Json{{"end", true}, {"go_on", go_on}}.dump());
}

bool assist(TraceTeam& team, const TraceJob& job, std::uint64_t seed, int threads, const Progress& progress) {
  requireSameAtAll(team, job.identity());
  for (;;) {
    const Json order = Json::parse(team.fromFirst({}));
    if (order.contains("end")) return order.at("go_on").get<bool>();
    const auto shares = order.at("shares").get<std::vector<std::uint64_t>>();
    const auto own = shares.begin() + team.rank();
    const std::uint64_t skipped = std::accumulate(shares.begin(), own, std::uint64_t{0});
    TraceSums found(job.bins(), job.groups());
    computeShare(team, job,
                 {.seed = seed,
                  .wanted = slice(unitsIn(order.at("units")), skipped, *own),
                  .threads = threads,
                  .seconds = order.at("seconds").get<double>()},
                 found, progress);
  }
}

}  // namespace sunfleck

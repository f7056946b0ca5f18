#include "render/reference/trace_file.hpp"

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <cstring>
#include <fstream>
#include <iterator>
#include <limits>
#include <nlohmann/json.hpp>
#include <span>

#include "core/require.hpp"
#include "core/whole_file.hpp"

namespace sunfleck {
namespace fs = std::filesystem;
namespace {

using Json = nlohmann::ordered_json;

constexpr std::string_view kMagic = "sunfleck trace 1\n";
// A file of so many bytes has no more bins than this: most bins of a run are met soon.
std::uint64_t mostBins(std::uint64_t bytes) {
  return 10'000'000 + 1000 * bytes / sizeof(TraceSums::Bin);
}

std::uint32_t crcOf(std::string_view bytes) {
  return static_cast<std::uint32_t>(crc32_z(0, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size()));
}

template <typename T>
void put(std::string& bytes, const T& value) {
  bytes.append(reinterpret_cast<const char*>(&value), sizeof(T));
}

// Takes values off the front of a file's bytes.
class Reader {
 public:
  Reader(std::string_view bytes, const fs::path& path) : bytes_(bytes), path_(path) {}

  std::string_view take(std::uint64_t count) {
    if (count > bytes_.size()) throw InvalidInput(path_.string() + ": damaged: it ends too early");
    const std::string_view taken = bytes_.substr(0, count);
    bytes_.remove_prefix(count);
    return taken;
  }
  template <typename T>
  T get() {
    T value;
    std::memcpy(&value, take(sizeof(T)).data(), sizeof(T));
    return value;
  }
  bool empty() const { return bytes_.empty(); }

 private:
  std::string_view bytes_;
  const fs::path& path_;
};

bool isZero(const TraceSums::Bin& bin) {
  return bin.sum.whole == 0 && bin.squares.whole == 0;
}

// The bins that are not zero, as runs: first, count, values.
void putBins(std::string& bytes, const TraceSums& sums) {
  for (std::uint64_t first = 0, last = 0; first < sums.bins(); first = last + 1) {
    while (first < sums.bins() && isZero(sums.bin(first))) ++first;
    for (last = first; last < sums.bins() && !isZero(sums.bin(last));) ++last;
    if (first == last) break;
    put(bytes, first);
    put(bytes, last - first);
    for (std::uint64_t i = first; i < last; ++i) put(bytes, sums.bin(i));
  }
  put(bytes, std::numeric_limits<std::uint64_t>::max());
}

Json headerOf(const TraceFile& file) {
  Json sections = Json::array();
  for (const TraceSection& section : file.sections) {
    Json done = Json::array();
    for (const auto& [seed, units] : section.sums.done()) done.push_back({{"seed", seed}, {"units", units.ranges()}});
    sections.push_back({{"name", section.name},
                        {"identity", section.identity},
                        {"bins", section.sums.bins()},
                        {"groups", section.sums.groups()},
                        {"done", done},
                        {"planned", section.planned.ranges()},
                        {"plan_of", section.plan_of},
                        {"asked", section.asked}});
  }
  return {{"run", file.run}, {"sections", sections}};
}

TraceSection readSection(const Json& header, Reader& body, std::uint64_t most_bins, const fs::path& path) {
  const auto damaged = [&](bool wrong) {
    if (wrong) throw InvalidInput(path.string() + ": damaged: its numbers contradict each other");
  };
  const auto bins = header.at("bins").get<std::uint64_t>();
  const auto groups = header.at("groups").get<std::uint64_t>();
  damaged(bins > most_bins || groups == 0);
  TraceSection section{.name = header.at("name").get<std::string>(),
                       .identity = header.at("identity").get<TraceIdentity>(),
                       .sums = TraceSums(bins, groups)};
  const auto unitsIn = [&](const Json& ranges) {
    UnitRanges units;
    for (const auto& [first, last] : ranges.get<std::vector<UnitRanges::Range>>()) {
      damaged(first >= last || units.overlap({first, last}) != UnitRanges::Range{0, 0});
      units.add(first, last);
    }
    return units;
  };
  section.planned = unitsIn(header.at("planned"));
  section.plan_of = header.at("plan_of").get<std::string>();
  section.asked = header.at("asked").get<std::uint64_t>();
  for (const Json& of_seed : header.at("done"))
    section.sums.restore(of_seed.at("seed").get<std::uint64_t>(), unitsIn(of_seed.at("units")));
  for (std::uint64_t first = 0; (first = body.get<std::uint64_t>()) != std::numeric_limits<std::uint64_t>::max();) {
    const auto count = body.get<std::uint64_t>();
    damaged(first >= bins || count > bins - first);
    for (std::uint64_t i = first; i < first + count; ++i) section.sums.restore(i, body.get<TraceSums::Bin>());
  }
  return section;
}

}  // namespace

void writeTraceFile(const fs::path& path, const TraceFile& file) {
  std::string bytes(kMagic);
  const std::string header = headerOf(file).dump(1, ' ', false, Json::error_handler_t::replace);
  put(bytes, std::uint64_t{header.size()});
  bytes += header;
  for (const TraceSection& section : file.sections) putBins(bytes, section.sums);
  put(bytes, crcOf(bytes));
  writeWhole(path, bytes);
}

TraceFile readTraceFile(const fs::path& path) {
  if (!fs::is_regular_file(path)) throw InvalidInput(path.string() + ": must be a file that can be read");
  std::ifstream in(path, std::ios::binary);
  const std::string bytes(std::istreambuf_iterator<char>(in), {});
  if (!in) throw InvalidInput(path.string() + ": cannot be read");
  if (!std::string_view(bytes).starts_with(kMagic.substr(0, kMagic.size() - 2)))
    throw InvalidInput(path.string() + ": must be a trace file of sunfleck");
  if (!bytes.starts_with(kMagic))
    throw InvalidInput(path.string() + ": must be a trace file of this version of the format");
  const std::size_t end = bytes.size() - std::min(bytes.size(), sizeof(std::uint32_t));
  std::uint32_t crc = 0;
  std::memcpy(&crc, bytes.data() + end, bytes.size() - end);
  if (end < kMagic.size() || crc != crcOf(std::string_view(bytes).substr(0, end)))
    throw InvalidInput(path.string() + ": damaged: its check sum is wrong");
  Reader reader(std::string_view(bytes).substr(kMagic.size(), end - kMagic.size()), path);
  TraceFile file;
  try {
    const Json header = Json::parse(reader.take(reader.get<std::uint64_t>()));
    file.run = header.at("run").get<TraceIdentity>();
    for (const Json& section : header.at("sections"))
      file.sections.push_back(readSection(section, reader, mostBins(bytes.size()), path));
  } catch (const Json::exception& e) {
    throw InvalidInput(path.string() + ": damaged: " + e.what());
  } catch (const std::bad_alloc&) {
    throw InvalidInput(path.string() + ": its sums do not fit into memory");
  }
  if (!reader.empty()) throw InvalidInput(path.string() + ": damaged: there is more than its header tells");
  return file;
}

TraceSection* TraceFile::find(const std::string& name) {
  const auto found = std::find_if(sections.begin(), sections.end(), [&](const auto& s) { return s.name == name; });
  return found == sections.end() ? nullptr : &*found;
}

void addPart(TraceFile& whole, const TraceFile& part, const fs::path& path) {
  if (whole.sections.empty()) whole.run = part.run;
  requireSame(path, part.run, whole.run);
  for (const TraceSection& section : part.sections) {
    TraceSection* const same = whole.find(section.name);
    if (!same) {
      whole.sections.push_back(section);
      continue;
    }
    requireSame(path, section.identity, same->identity);
    if (section.sums.bins() != same->sums.bins() || section.sums.groups() != same->sums.groups())
      throw InvalidInput(path.string() + ": damaged: it has other bins than its estimator");
    for (const auto& [seed, units] : section.sums.done()) {
      const auto [first, last] = units.overlap(same->sums.done(seed));
      if (first < last)
        throw InvalidInput(fmt::format("{}: units {} to {} of seed {} of {}: must not be in another file too",
                                       path.string(), first, last - 1, seed, section.name));
    }
    same->sums.add(section.sums);
    same->asked = std::max(same->asked, section.asked);
    same->planned = {};
  }
}

std::map<std::uint64_t, UnitRanges> missingUnits(const TraceSection& section) {
  std::map<std::uint64_t, UnitRanges> missing;
  for (const auto& [seed, units] : section.sums.done())
    if (UnitRanges left = UnitRanges(0, section.asked).without(units); left.count() > 0)
      missing[seed] = std::move(left);
  return missing;
}

void requireSame(const fs::path& path, const TraceIdentity& found, const TraceIdentity& expected) {
  const auto valueIn = [](const TraceIdentity& identity, const std::string& name) {
    const auto at = identity.find(name);
    return at == identity.end() ? std::string("none") : at->second;
  };
  const auto compare = [&](const std::string& name) {
    const std::string is = valueIn(found, name), should = valueIn(expected, name);
    if (is == should) return;
    // Of long lists, where they part.
    constexpr std::size_t kMostShown = 400, kAround = 40;
    const bool cut = std::max(is.size(), should.size()) > kMostShown;
    const auto parting =
        static_cast<std::size_t>(std::mismatch(is.begin(), is.end(), should.begin(), should.end()).first - is.begin());
    const auto shown = [&](const std::string& text) {
      return cut ? "... " + text.substr(parting - std::min(parting, kAround), 2 * kAround) + " ..." : text;
    };
    throw InvalidInput(fmt::format("{}: made with {} = {}: must be {}", path.string(), name, shown(is), shown(should)));
  };
  for (const auto& [name, value] : expected) compare(name);
  for (const auto& [name, value] : found) compare(name);
}

}  // namespace sunfleck

#include "apps/slab_batch.hpp"

#include <fmt/format.h>
#include <sys/stat.h>
#include <tbb/parallel_pipeline.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <charconv>
#include <cstdio>
#include <cstring>
#include <exception>
#include <memory>
#include <vector>

#include "apps/number_text.hpp"
#include "apps/slab_options.hpp"
#include "core/require.hpp"
#include "core/whole_file.hpp"

namespace sunfleck::apps {
namespace {

constexpr std::string_view kHeader = "g,omega,thickness,mu0";
constexpr std::size_t kBlock = 512 * 1024;  // bytes read at once: some 16,000 lines
constexpr std::array kFields{"g", "omega", "thickness", "mu0"};

struct CloseFile {
  void operator()(std::FILE* file) const { std::fclose(file); }
};
using File = std::unique_ptr<std::FILE, CloseFile>;

std::string_view trimmed(std::string_view line) {
  while (!line.empty() && (line.back() == '\r' || line.back() == ' ')) line.remove_suffix(1);
  return line;
}

// Whole lines of the file and what becomes of them.
struct Chunk {
  std::string text;
  std::size_t first_line = 0, bytes_read = 0;  // the number of its first line; how far the file has been read after it
  std::string results;
  std::exception_ptr failure;
};

// Reads blocks and cuts them after their last whole line.
class Lines {
 public:
  explicit Lines(const std::string& name) : name_(name), file_(std::fopen(name.c_str(), "rb")) {
    struct stat about {};
    if (!file_ || fstat(fileno(file_.get()), &about) != 0 || S_ISDIR(about.st_mode))
      throw InvalidInput(name + ": cannot be read");
    size_ = S_ISREG(about.st_mode) ? static_cast<std::size_t>(about.st_size) : 0;
  }

  std::size_t size() const { return size_; }  // [byte], 0 if it cannot be known

  // The next lines; an empty text at the end.
  void next(Chunk& chunk) {
    chunk.text.swap(rest_);
    const std::size_t kept = chunk.text.size();
    chunk.text.resize(kept + kBlock);
    const std::size_t got = std::fread(chunk.text.data() + kept, 1, kBlock, file_.get());
    if (got < kBlock && std::ferror(file_.get()))
      throw InvalidInput(name_ + ": cannot be read: " + std::strerror(errno));
    chunk.text.resize(kept + got);
    bytes_ += got;
    if (bytes_ == 0) throw InvalidInput(fmt::format("{}:1: \"\": must be {}", name_, kHeader));
    if (got == kBlock) {
      const std::size_t end = chunk.text.rfind('\n');
      if (end == std::string::npos)
        throw InvalidInput(fmt::format("{}:{}: a line of more than {} characters", name_, line_, kBlock));
      rest_.assign(chunk.text, end + 1);
      chunk.text.resize(end + 1);
    }
    chunk.first_line = line_;
    chunk.bytes_read = bytes_;
    line_ += static_cast<std::size_t>(std::ranges::count(chunk.text, '\n'));
  }

 private:
  std::string name_;
  File file_;
  std::string rest_;
  std::size_t size_ = 0, bytes_ = 0, line_ = 1;
};

pp::SlabCase parsed(std::string_view line, const std::string& file, std::size_t number) {
  const auto where = [&] { return fmt::format("{}:{}: ", file, number); };
  std::array<double, 4> values{};
  std::size_t count = 0;
  for (std::string_view left = line;; ++count) {
    const std::size_t comma = left.find(',');
    if (count < 4) {
      const std::string_view field = left.substr(0, comma);
      const std::optional<double> value = numberOf(field);
      if (!value)
        throw InvalidInput(
            fmt::format("{}{} = \"{}\": must be a number", where(), kFields[count], field.substr(0, 40)));
      values[count] = *value;
    }
    if (comma == std::string_view::npos) break;
    left.remove_prefix(comma + 1);
  }
  if (++count != 4)
    throw InvalidInput(fmt::format("{}{} field{}: must be 4, {}", where(), count, count == 1 ? "" : "s", kHeader));
  const pp::SlabCase slab{.asymmetry = values[0], .albedo = values[1], .thickness = values[2], .mu0 = values[3]};
  const bool in_range = slab.asymmetry > -1. && slab.asymmetry < 1. && slab.albedo >= 0. && slab.albedo <= 1. &&
                        slab.thickness > 0. && slab.mu0 > 0. && slab.mu0 <= 1.;
  if (!in_range) requireSlabCase(slab, where());  // throws: the text of the place is made only then
  return slab;
}

void append(std::string& text, double value) {
  std::array<char, 32> digits;
  const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr;
  text += ',';
  text.append(digits.data(), end);
}

class Batch {
 public:
  Batch(const std::string& file, const SolveCases& solve, bool names_models)
      : file_(file), solve_(solve), names_models_(names_models) {}

  // Lines to results. The first chunk holds the header.
  void solve(Chunk& chunk) const {
    std::vector<std::string_view> lines;
    std::vector<pp::SlabCase> cases;
    std::string_view text = chunk.text;
    for (std::size_t number = chunk.first_line; !text.empty(); ++number) {
      const std::size_t end = std::min(text.find('\n'), text.size());
      const std::string_view line = trimmed(text.substr(0, end));
      text.remove_prefix(std::min(end + 1, text.size()));
      if (number == 1) {
        constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";  // as spreadsheets write it
        if ((line.starts_with(kByteOrderMark) ? line.substr(kByteOrderMark.size()) : line) != kHeader)
          throw InvalidInput(fmt::format("{}:1: \"{}\": must be {}", file_, line.substr(0, 80), kHeader));
        chunk.results = fmt::format("{},reflectance,transmittance,direct{}\n", kHeader, names_models_ ? ",model" : "");
      } else if (!line.empty()) {
        cases.push_back(parsed(line, file_, number));
        lines.push_back(line);
      }
    }
    const std::vector<ChosenFluxes> results = solve_(cases);
    chunk.results.reserve(chunk.text.size() + 64 * cases.size() + 64);
    for (std::size_t i = 0; i < cases.size(); ++i) {
      chunk.results += lines[i];
      append(chunk.results, results[i].fluxes.reflectance);
      append(chunk.results, results[i].fluxes.transmittance);
      append(chunk.results, results[i].fluxes.direct);
      if (names_models_) chunk.results += ',' + results[i].model;
      chunk.results += '\n';
    }
  }

 private:
  std::string file_;
  const SolveCases& solve_;
  bool names_models_;
};

void write(std::FILE* file, std::string_view text, const std::string& name) {
  if (std::fwrite(text.data(), 1, text.size(), file) != text.size())
    throw std::runtime_error(fmt::format("{} could not be written: {}", name, std::strerror(errno)));
}

// Reads, solves and writes side by side, in the order of the lines. A wrong line is told when its turn to be written
// comes, so that it is the first of the file whatever thread met it. False if `progress` has ended it.
bool stream(const std::string& cases, const Batch& batch, std::FILE* out, const std::string& out_name,
            const Progress& progress) {
  Lines lines(cases);
  std::atomic<bool> stopped = false;
  using ChunkPointer = std::shared_ptr<Chunk>;
  const auto read = [&](tbb::flow_control& control) {
    auto chunk = std::make_shared<Chunk>();
    try {
      lines.next(*chunk);
      if (stopped || chunk->text.empty()) control.stop();
    } catch (...) {
      chunk->failure = std::current_exception();
    }
    return chunk;
  };
  const auto solve = [&](ChunkPointer chunk) {
    if (!chunk->failure) try {
        batch.solve(*chunk);
      } catch (...) {
        chunk->failure = std::current_exception();
      }
    return chunk;
  };
  const auto put = [&](const ChunkPointer& chunk) {
    if (stopped) return;
    if (chunk->failure) std::rethrow_exception(chunk->failure);
    write(out, chunk->results, out_name);
    const double done = lines.size() ? static_cast<double>(chunk->bytes_read) / static_cast<double>(lines.size()) : 0.;
    if (!goOn(progress, std::min(done, 1.))) stopped = true;
  };
  const auto tokens = 2 * static_cast<std::size_t>(std::max(1, tbb::this_task_arena::max_concurrency()));
  tbb::parallel_pipeline(tokens, tbb::make_filter<void, ChunkPointer>(tbb::filter_mode::serial_in_order, read) &
                                     tbb::make_filter<ChunkPointer, ChunkPointer>(tbb::filter_mode::parallel, solve) &
                                     tbb::make_filter<ChunkPointer, void>(tbb::filter_mode::serial_in_order, put));
  return !stopped;
}

struct Interrupted {};

}  // namespace

bool solveBatch(const std::string& cases, const SolveCases& solve, bool names_models,
                const std::filesystem::path& output, const Progress& progress) {
  const Batch batch(cases, solve, names_models);
  if (!output.empty()) try {
      writeWhole(output, [&](const std::filesystem::path& temporary) {
        File out(std::fopen(temporary.c_str(), "wb"));
        if (!out) throw InvalidInput(output.string() + ": cannot be written: " + std::strerror(errno));
        if (!stream(cases, batch, out.get(), output.string(), progress)) throw Interrupted{};
        if (std::fclose(out.release()) != 0)
          throw std::runtime_error(output.string() + " could not be written: " + std::strerror(errno));
      });
      return true;
    } catch (Interrupted) {
      return false;
    }

  const File spool(std::tmpfile());
  if (!spool) throw std::runtime_error(fmt::format("no temporary file could be made: {}", std::strerror(errno)));
  if (!stream(cases, batch, spool.get(), "a temporary file", progress)) return false;
  std::rewind(spool.get());
  std::vector<char> block(kBlock);
  while (const std::size_t got = std::fread(block.data(), 1, block.size(), spool.get()))
    write(stdout, {block.data(), got}, "the results");
  if (std::ferror(spool.get())) throw std::runtime_error("a temporary file could not be read back");
  return true;
}

}  // namespace sunfleck::apps

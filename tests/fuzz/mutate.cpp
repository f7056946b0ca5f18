// Runs a fuzz target on files of a corpus and on changed ones: mutate runs COUNT FILE... or mutate seconds COUNT
// FILE... The targets have libFuzzer's entry, so that a build by clang with -fsanitize=fuzzer can take the place of
// this file. The project is built by g++, which has no libFuzzer: this one runs wherever the tests do, under the
// sanitizers too, and the same changes come in the same order on every machine. It knows no coverage; it knows what
// such files are made of: numbers, counts and tokens.
#include <sys/resource.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <string>
#include <string_view>
#include <vector>

#include "core/random.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

namespace {

using sunfleck::Random;

constexpr std::array<std::string_view, 24> kTokens{
    "nan",        "-inf",       "1e999", "-1",   "0",        "99999999999999999999",
    "2147483648", "4294967295", "1e-45", "-0",   "f ",       "v ",
    "\n",         "usemtl a\n", "//",    "0x10", "\xff\xfe", "{",
    "}",          "[[[[",       "null",  "\"\"", ",",        "1e30"};

class Mutator {
 public:
  Mutator(std::vector<std::string> corpus, std::uint64_t seed) : corpus_(std::move(corpus)), random_(seed, 0) {}

  std::string next() {
    std::string bytes = corpus_[below(corpus_.size())];
    for (std::size_t changes = 1 + below(4); changes > 0; --changes) change(bytes);
    return bytes;
  }

 private:
  std::size_t below(std::size_t count) {
    return std::min(static_cast<std::size_t>(random_.uniform() * static_cast<float>(count)), count - 1);
  }

  void change(std::string& bytes) {
    if (bytes.empty()) bytes = " ";
    const std::size_t at = below(bytes.size());
    const std::size_t length = std::min(bytes.size() - at, std::size_t{1} << below(7));
    switch (below(9)) {
      case 0:
        bytes[at] = static_cast<char>(bytes[at] ^ (1 << below(8)));
        break;
      case 1:
        bytes[at] = static_cast<char>(below(256));
        break;
      case 2:
        bytes.resize(at);
        break;
      case 3:
        bytes.erase(at, length);
        break;
      case 4:
        bytes.insert(below(bytes.size()), bytes.substr(at, length));
        break;
      case 5:
        bytes.insert(at, kTokens[below(kTokens.size())]);
        break;
      case 6:
        replaceNumber(bytes, at);
        break;
      case 7: {  // a count or an offset of four bytes
        constexpr std::array<std::uint32_t, 6> kCounts{0u, 1u, 0x7fffffffu, 0x80000000u, 0xffffffffu, 0x00ffffffu};
        const std::uint32_t count = kCounts[below(kCounts.size())];
        for (std::size_t i = 0; i < 4 && at + i < bytes.size(); ++i)
          bytes[at + i] = static_cast<char>((count >> (8 * i)) & 0xffu);
        break;
      }
      default: {
        const std::string& other = corpus_[below(corpus_.size())];
        const std::size_t from = below(other.size());
        bytes.replace(at, length, other, from, std::size_t{1} << below(9));
      }
    }
  }

  // The digits at or after a place become a token.
  void replaceNumber(std::string& bytes, std::size_t at) {
    const std::size_t start = bytes.find_first_of("0123456789", at);
    if (start == std::string::npos) return;
    const std::size_t end = std::min(bytes.find_first_not_of("0123456789.eE+-", start), bytes.size());
    bytes.replace(start, end - start, kTokens[below(kTokens.size())]);
  }

  std::vector<std::string> corpus_;
  Random random_;
};

}  // namespace

int main(int count, char** words) {
  if (count < 4) {
    std::fputs("mutate runs|seconds COUNT FILE...\n", stderr);
    return 2;
  }
  const bool by_time = std::string_view(words[1]) == "seconds";
  const double most = std::atof(words[2]);
  std::vector<std::string> corpus;
  for (int i = 3; i < count; ++i) {
    std::ifstream in(words[i], std::ios::binary);
    corpus.emplace_back(std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>());
    if (corpus.back().empty()) {
      std::fprintf(stderr, "%s: must be a file that is not empty\n", words[i]);
      return 2;
    }
  }
  const auto run = [](const std::string& bytes) {
    LLVMFuzzerTestOneInput(reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size());
  };
  for (const std::string& bytes : corpus) run(bytes);
  Mutator mutator(corpus, 1);
  const auto start = std::chrono::steady_clock::now();
  double runs = 0.;
  const auto goesOn = [&] {
    const std::chrono::duration<double> past = std::chrono::steady_clock::now() - start;
    return by_time ? past.count() < most : runs < most;
  };
  for (; goesOn(); ++runs) run(mutator.next());
  rusage use{};
  getrusage(RUSAGE_SELF, &use);
  std::printf("%.0f runs, %ld MB at most\n", runs, use.ru_maxrss / 1024);
#ifndef __SANITIZE_ADDRESS__
  // The corpus' files are of a few kilobytes: what is beyond these megabytes came of a count that was believed.
  constexpr long kMostMemory = 200 * 1024;  // [kB]
  if (use.ru_maxrss > kMostMemory) return 1;
#endif
  return 0;
}

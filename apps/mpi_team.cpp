#include <fmt/format.h>
#include <mpi.h>
#include <sched.h>
#include <tbb/info.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstring>
#include <stdexcept>
#include <thread>

#include "apps/started_by_mpi.hpp"
#include "apps/team.hpp"

namespace sunfleck::apps {
namespace {

constexpr int kAnyTag = 0;

// MPI's own waiting keeps a core busy.
void wait(MPI_Request request) {
  using std::chrono::microseconds;
  constexpr microseconds kShortest(20), kLongest(1000);
  microseconds pause = kShortest;
  for (int done = 0; MPI_Test(&request, &done, MPI_STATUS_IGNORE), !done; pause = std::min(2 * pause, kLongest))
    std::this_thread::sleep_for(pause);
}

void addWholes(void* from, void* to, int* count, MPI_Datatype*) {
  using Whole = ExactSum::Whole;
  auto* source = static_cast<const char*>(from);
  auto* sum = static_cast<char*>(to);
  for (int i = 0; i < *count; ++i, source += sizeof(Whole), sum += sizeof(Whole)) {
    Whole a, b;
    std::memcpy(&a, source, sizeof a);
    std::memcpy(&b, sum, sizeof b);
    b += a;
    std::memcpy(sum, &b, sizeof b);
  }
}

int lengthOf(const std::string& text) {
  if (text.size() > 2'000'000'000) throw std::length_error("a message of more than 2 GB between ranks");
  return static_cast<int>(text.size());
}

class MpiTeam final : public Team {
 public:
  MpiTeam() {
    int provided = 0;
    MPI_Init_thread(nullptr, nullptr, MPI_THREAD_MULTIPLE, &provided);
    MPI_Comm_rank(MPI_COMM_WORLD, &rank_);
    MPI_Comm_size(MPI_COMM_WORLD, &size_);
    if (provided < MPI_THREAD_MULTIPLE) fail(1, "this MPI takes no calls from several threads");
    MPI_Type_contiguous(sizeof(ExactSum::Whole), MPI_BYTE, &whole_);
    MPI_Type_commit(&whole_);
    MPI_Op_create(addWholes, 1, &add_);
    fair_threads_ = shareOfCores();
    if (rank_ == 0) return;
    // Rank 0 speaks for all, except of what went wrong elsewhere.
    errors_ = fdopen(dup(STDERR_FILENO), "w");
    for (std::FILE* stream : {stdout, stderr})
      if (!std::freopen("/dev/null", "w", stream)) fail(1, "/dev/null cannot be opened");
  }
  ~MpiTeam() override { MPI_Finalize(); }
  MpiTeam(const MpiTeam&) = delete;
  MpiTeam& operator=(const MpiTeam&) = delete;

  int rank() const override { return rank_; }
  int size() const override { return size_; }
  int fairThreads() const override { return fair_threads_; }

  std::string fromFirst(std::string text) override {
    int length = lengthOf(text);
    MPI_Request request{};
    MPI_Ibcast(&length, 1, MPI_INT, 0, MPI_COMM_WORLD, &request);
    wait(request);
    text.resize(static_cast<std::size_t>(length));
    MPI_Ibcast(text.data(), length, MPI_CHAR, 0, MPI_COMM_WORLD, &request);
    wait(request);
    return text;
  }

  std::vector<std::string> toFirst(const std::string& text) override {
    const int length = lengthOf(text);
    const bool first = rank_ == 0;
    const auto ranks = static_cast<std::size_t>(first ? size_ : 0);
    std::vector<int> lengths(ranks), starts(ranks);
    MPI_Request request{};
    MPI_Igather(&length, 1, MPI_INT, lengths.data(), 1, MPI_INT, 0, MPI_COMM_WORLD, &request);
    wait(request);
    std::string all;
    for (std::size_t rank = 0; rank < ranks; ++rank) {
      starts[rank] = lengthOf(all);
      all.resize(all.size() + static_cast<std::size_t>(lengths[rank]));
    }
    MPI_Igatherv(text.data(), length, MPI_CHAR, all.data(), lengths.data(), starts.data(), MPI_CHAR, 0, MPI_COMM_WORLD,
                 &request);
    wait(request);
    std::vector<std::string> texts;
    for (std::size_t rank = 0; rank < ranks; ++rank)
      texts.push_back(all.substr(static_cast<std::size_t>(starts[rank]), static_cast<std::size_t>(lengths[rank])));
    return texts;
  }

  // In pieces, as MPI keeps as much again of each.
  void sumToFirst(std::span<TraceSums::Bin> bins) override {
    constexpr std::size_t kPiece = 1 << 18, kWholes = sizeof(TraceSums::Bin) / sizeof(ExactSum::Whole);
    for (; !bins.empty(); bins = bins.subspan(std::min(kPiece, bins.size()))) {
      const auto wholes = static_cast<int>(kWholes * std::min(kPiece, bins.size()));
      MPI_Request request{};
      MPI_Ireduce(rank_ == 0 ? MPI_IN_PLACE : bins.data(), bins.data(), wholes, whole_, add_, 0, MPI_COMM_WORLD,
                  &request);
      wait(request);
    }
  }

  void tellFirst(const std::string& text) override { answer(0, text); }
  void answer(int rank, const std::string& text) override {
    MPI_Request request{};
    MPI_Isend(text.data(), lengthOf(text), MPI_CHAR, rank, kAnyTag, MPI_COMM_WORLD, &request);
    wait(request);
  }

  std::string hearFirst() override {
    for (;; std::this_thread::sleep_for(std::chrono::milliseconds(1)))
      if (std::optional<std::pair<int, std::string>> message = heardFrom(0)) return std::move(message->second);
  }
  std::optional<std::pair<int, std::string>> heard() override { return heardFrom(MPI_ANY_SOURCE); }

  // A mistake that all ranks see is told by the first: the others give it time.
  void fail(int status, std::string message) override {
    if (rank_ > 0) std::this_thread::sleep_for(std::chrono::seconds(2));
    std::FILE* const out = errors_ ? errors_ : stderr;
    fmt::print(out, "sunfleck: {}{}\n", rank_ > 0 ? fmt::format("rank {}: ", rank_) : "", message);
    std::fflush(out);
    MPI_Abort(MPI_COMM_WORLD, status);
    _exit(status);
  }

 private:
  static std::optional<std::pair<int, std::string>> heardFrom(int rank) {
    int waits = 0, length = 0;
    MPI_Status status{};
    MPI_Message message{};
    MPI_Improbe(rank, kAnyTag, MPI_COMM_WORLD, &waits, &message, &status);
    if (!waits) return std::nullopt;
    MPI_Get_count(&status, MPI_CHAR, &length);
    std::string text(static_cast<std::size_t>(length), '\0');
    MPI_Mrecv(text.data(), length, MPI_CHAR, &message, MPI_STATUS_IGNORE);
    return std::pair(status.MPI_SOURCE, std::move(text));
  }

  // mpirun may bind each process to cores of its own or let several have the same.
  int shareOfCores() const {
    MPI_Comm machine{};
    MPI_Comm_split_type(MPI_COMM_WORLD, MPI_COMM_TYPE_SHARED, rank_, MPI_INFO_NULL, &machine);
    int here = 0;
    MPI_Comm_size(machine, &here);
    cpu_set_t own{};
    sched_getaffinity(0, sizeof own, &own);
    std::vector<cpu_set_t> all(static_cast<std::size_t>(here));
    MPI_Allgather(&own, sizeof own, MPI_BYTE, all.data(), sizeof own, MPI_BYTE, machine);
    MPI_Comm_free(&machine);
    const auto same = std::count_if(all.begin(), all.end(), [&](const cpu_set_t& of) { return CPU_EQUAL(&of, &own); });
    return std::max(1, tbb::info::default_concurrency() / static_cast<int>(same));
  }

  int rank_ = 0, size_ = 1, fair_threads_ = 1;
  MPI_Datatype whole_{};
  MPI_Op add_{};
  std::FILE* errors_ = nullptr;
};

}  // namespace

std::unique_ptr<Team> joinTeam() {
  return startedByMpi() ? std::make_unique<MpiTeam>() : nullptr;
}

}  // namespace sunfleck::apps

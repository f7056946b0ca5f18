#include "grid/product_graph.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <chrono>
#include <stdexcept>
#include <utility>

#include "core/revision.hpp"

namespace sunfleck {
namespace {

// Progress is told after each batch; one of few members would not keep all cores at work.
constexpr std::size_t kBatches = 64, kFewest = 16;

double now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

}  // namespace

Stopwatch::Stopwatch(double& seconds) : seconds_(seconds), start_(now()) {}
Stopwatch::~Stopwatch() {
  seconds_ += now() - start_;
}

ProductGraph::Product ProductGraph::add(std::string name) {
  products_.emplace_back().cost.name = std::move(name);
  return products_.size() - 1;
}

void ProductGraph::follows(Product later, Product earlier, Followers followers) {
  products_[earlier].edges.push_back({later, std::move(followers)});
}

void ProductGraph::resize(Product product, std::size_t members) {
  products_[product].stale.resize(members, 1);
  products_[product].revision.resize(members, 0);
}

void ProductGraph::touch(Product product, std::size_t member) {
  Node& node = products_[product];
  if (node.stale[member]) return;
  node.stale[member] = 1;
  for (const Edge& edge : node.edges)
    edge.followers(member, [&](std::size_t follower) { touch(edge.later, follower); });
}

void ProductGraph::touchAll(Product product) {
  for (std::size_t member = 0; member < products_[product].stale.size(); ++member) touch(product, member);
}

void ProductGraph::bring(Product product, std::span<const std::size_t> members,
                         const std::function<void(std::size_t)>& make, const Progress& progress) {
  Node& node = products_[product];
  std::vector<std::size_t> due;
  for (const std::size_t member : members)
    if (node.stale[member]) due.push_back(member);
  std::sort(due.begin(), due.end());
  due.erase(std::unique(due.begin(), due.end()), due.end());
  node.cost.reused += members.size() - due.size();
  if (due.empty()) return;
  const Stopwatch watch(node.cost.seconds);
  const std::uint64_t first_revision = newRevisions(due.size());
  const std::size_t batches = progress ? std::clamp<std::size_t>(due.size() / kFewest, 1, kBatches) : 1;
  for (std::size_t batch = 0; batch < batches; ++batch) {
    const std::size_t begin = due.size() * batch / batches, end = due.size() * (batch + 1) / batches;
    tbb::parallel_for(begin, end, [&](std::size_t i) {
      make(due[i]);
      node.stale[due[i]] = 0;
      node.revision[due[i]] = first_revision + i;
    });
    node.cost.made += end - begin;
    if (!goOn(progress, static_cast<double>(batch + 1) / static_cast<double>(batches)))
      throw std::runtime_error("interrupted");
  }
}

std::vector<ProductCost> ProductGraph::costs() const {
  std::vector<ProductCost> costs;
  for (const Node& node : products_) costs.push_back(node.cost);
  return costs;
}

}  // namespace sunfleck

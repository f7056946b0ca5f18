#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "core/progress.hpp"

namespace sunfleck {

// What a product has cost so far, for people to read.
struct ProductCost {
  std::string name;
  std::size_t made = 0;      // members computed, again or for the first time
  std::size_t reused = 0;    // members asked for that were up to date
  std::size_t adjusted = 0;  // members that were changed in part instead of being made again
  std::size_t skipped = 0;   // parts of members that nothing needs, such as cells without light
  double seconds = 0.;       // wall time
};

// Products that are computed from one another, and which of them are stale. A product has members, such as one for each
// tree; a member that becomes stale makes those stale that follow from it. It knows nothing of the values, which their
// owner keeps.
class ProductGraph {
 public:
  using Product = std::size_t;
  // Calls back for each member of the later product that follows from a member of the earlier one.
  using Mark = std::function<void(std::size_t)>;
  using Followers = std::function<void(std::size_t member, const Mark&)>;

  Product add(std::string name);
  void follows(Product later, Product earlier, Followers followers);
  void resize(Product product, std::size_t members);  // new members are stale

  bool stale(Product product, std::size_t member) const { return products_[product].stale[member]; }
  // Of what was last made of a member: another number for each making of any member of any product of any graph; 0:
  // never made.
  std::uint64_t revision(Product product, std::size_t member) const { return products_[product].revision[member]; }
  // Marks a member stale and all that follows from it. What is stale already has stale followers and costs nothing.
  void touch(Product product, std::size_t member);
  void touchAll(Product product);

  // Computes the stale ones among `members`, in parallel: make(member). They are up to date afterwards, unless
  // `progress` ends it: then std::runtime_error("interrupted"), and those made so far stay. Members of what it is
  // computed from must be up to date.
  void bring(Product product, std::span<const std::size_t> members, const std::function<void(std::size_t)>& make,
             const Progress& progress = {});

  ProductCost& cost(Product product) { return products_[product].cost; }
  std::vector<ProductCost> costs() const;  // of all products, in the order in which they were added

 private:
  struct Edge {
    Product later;
    Followers followers;
  };
  struct Node {
    ProductCost cost;
    std::vector<char> stale;  // not bool: threads write side by side
    std::vector<std::uint64_t> revision;
    std::vector<Edge> edges;
  };
  std::vector<Node> products_;
};

// Adds the wall time from its making to its end.
class Stopwatch {
 public:
  explicit Stopwatch(double& seconds);
  ~Stopwatch();
  Stopwatch(const Stopwatch&) = delete;
  Stopwatch& operator=(const Stopwatch&) = delete;

 private:
  double& seconds_;
  double start_;
};

}  // namespace sunfleck

// bench_ratios.h: how much faster is Boxwood than a peer?
//
// Ratios of medians, ours over theirs, above 1 where we are faster. Single rays stand beside single rays;
// a batch has to beat the better of the peer's single rays and packets.
#pragma once

#include <cmath>
#include <optional>
#include <string>

#include "bench.h"

namespace boxwood::app {

/// The median rate of one measurement; none when it was not made.
std::optional<double> rate_of(const BenchReport& report, const std::string& scene, const std::string& engine,
                              const std::string& mode, const std::string& set, int threads);

/// Boxwood's rate in `mode`, "single" or "batch", over the peer's.
std::optional<double> ratio_of(const BenchReport& report, const std::string& scene, const std::string& peer,
                               const std::string& mode, const std::string& set, int threads);

/// Of several ratios: the geometric mean, and which is worst.
class Spread {
 public:
  /// `most_is_worst` for quantities that should be small.
  explicit Spread(bool most_is_worst = false) : most_is_worst_(most_is_worst) {}
  void add(double value, const std::string& where) {
    if (count_ == 0 || (most_is_worst_ ? value > worst_ : value < worst_)) {
      worst_ = value;
      where_ = where;
    }
    log_sum_ += std::log(value);
    ++count_;
  }
  bool is_empty() const { return count_ == 0; }
  double mean() const { return std::exp(log_sum_ / double(count_)); }
  double worst() const { return worst_; }
  const std::string& where() const { return where_; }

 private:
  bool most_is_worst_;
  int count_ = 0;
  double log_sum_ = 0, worst_ = 0;
  std::string where_;
};

/// A line of the summary: a kind of work, and how Boxwood does it beside each peer.
struct Comparison {
  std::string what;
  int threads = 1;
  std::vector<Spread> beside;  ///< One for each peer, as in BenchReport::engines; empty where none applies.
};

/// Single rays, batches by kind of ray, and builds; lines that were not measured at all are left out.
std::vector<Comparison> compare_with_peers(const BenchReport& report);

/// A line about one engine beside itself, or alone.
struct Figure {
  std::string what;
  int threads = 1;
  bool is_ratio = true;
  Spread spread;
};

/// What presets gain, what short batches keep, bytes.
std::vector<Figure> own_figures(const BenchReport& report);

}  // namespace boxwood::app

// cluster.h: how do machines share a render, when mpirun starts the program on each of them?
//
// Rank 0 leads: it hands out units of the present round and adds up what comes back, and renders itself
// meanwhile. Whoever is done gets more, so a slow rank does less; and what it was given near the end of a
// round, others render too, so nobody waits for it. The film takes each unit once, whoever brought it first:
// the picture has the bits of a render on one machine.
#pragma once

#include <memory>
#include <string>

#include "boxwood/render/job.h"

namespace boxwood::app {

/// Whether mpirun started this program together with others.
bool is_in_cluster();

/// This program's place among the others. Made on the main thread, and used there.
class Cluster {
 public:
  /// Joins the others. Throws std::runtime_error when the program was built without Open MPI.
  Cluster();
  /// Ends the others' work when this is rank 0, and waits until all are told.
  ~Cluster();
  Cluster(const Cluster&) = delete;
  Cluster& operator=(const Cluster&) = delete;

  bool is_leader() const;
  /// How many ranks there are.
  int size() const;

  /// For the leader: all ranks work on the tasks of `job`. `warn` is told when a rank cannot help.
  render::RenderJob::Crew crew(const render::RenderJob& job, std::function<void(const std::string&)> warn);

  /// For the others: work for the leader until it says that all is done.
  void help(const render::RenderJob& job);
  /// The same, for a rank that cannot help, and why.
  void cannot_help(const std::string& why);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace boxwood::app

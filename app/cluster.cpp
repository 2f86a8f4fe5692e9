#include "cluster.h"

#include <cstdlib>
#include <stdexcept>

namespace boxwood::app {

bool is_in_cluster() {
  const char* size = std::getenv("OMPI_COMM_WORLD_SIZE");
  return size && std::atoi(size) > 1;
}

}  // namespace boxwood::app

#ifdef BOXWOOD_HAS_MPI

#include <algorithm>
#include <cstring>

#include "boxwood/render/checkpoint.h"
#include "boxwood/render/shard.h"
#include "rank_mail.h"

namespace boxwood::app {
namespace {

using render::RenderJob;
using render::Task;

/// What messages are about. The leader sends tasks and quit, the others all else.
enum Tag { kHello = 1, kTasks, kResult, kQuit, kBye };

/// How a rank introduces itself; the facts of its job follow, or what keeps it from working.
struct Hello {
  std::int32_t threads;  // 0: it cannot help
};

/// What a task brought; the words of its sums follow.
struct ResultHead {
  Task task;
  render::Effort effort;
};

template <class T>
void append(std::vector<char>& bytes, const T* values, std::size_t count) {
  const char* first = reinterpret_cast<const char*>(values);
  bytes.insert(bytes.end(), first, first + count * sizeof(T));
}

void say_hello(Hello hello, const std::string& text) {
  std::vector<char> bytes(sizeof(hello) + text.size());
  std::memcpy(bytes.data(), &hello, sizeof(hello));
  std::copy(text.begin(), text.end(), bytes.begin() + sizeof(hello));
  send(0, kHello, bytes);
}

Executor& executor_of(const RenderJob& job) {
  return job.options().executor ? *job.options().executor : default_executor();
}

/// Calls work(tasks) with a share of them for each thread.
template <class Work>
void for_each_share(Executor& executor, std::span<const Task> tasks, const Work& work) {
  const auto threads = static_cast<std::size_t>(executor.concurrency());
  const std::size_t share = (tasks.size() + threads - 1) / threads;
  parallel_for(executor, 0, (tasks.size() + share - 1) / share, 1, [&](std::size_t i) {
    work(tasks.subspan(i * share, std::min(share, tasks.size() - i * share)));
  });
}

std::vector<char> packed(const Task& task, const render::UnitResult& result) {
  const ResultHead head{task, result.effort};
  std::vector<std::uint32_t> words(result.sums.word_count());
  result.sums.to_words(words);
  std::vector<char> bytes;
  append(bytes, &head, 1);
  append(bytes, words.data(), words.size());
  return bytes;
}

/// Hands in what another rank rendered, unless it belongs to a round that is over.
void hand_in(RenderJob& job, const std::vector<char>& bytes) {
  ResultHead head;
  std::memcpy(&head, bytes.data(), sizeof(head));
  const render::Round& round = job.round();
  if (head.task.index >= round.unit_count() ||
      round.unit(head.task.unit.tile, head.task.index).first != head.task.unit.first)
    return;
  render::UnitResult result{job.film().empty_tile(head.task.unit.tile), head.effort};
  std::vector<std::uint32_t> words(result.sums.word_count());
  std::memcpy(words.data(), bytes.data() + sizeof(head), words.size() * 4);
  result.sums.from_words(words);
  job.add(head.task, result);
}

}  // namespace

struct Cluster::State {
  /// What the leader knows of another rank.
  struct Helper {
    std::size_t threads = 0;    // 0: it has not said hello, or cannot help
    std::size_t busy_with = 0;  // tasks,
    std::size_t sent_last = 0;  // so many of them in the last message
  };

  int rank = 0, size = 1;
  std::vector<Helper> helpers;  // by rank; the leader's own is not used
  render::Facts facts;          // of the leader's job
  std::function<void(const std::string&)> warn;

  /// What the leader does with whatever has arrived.
  void serve(RenderJob& job) {
    Message message;
    while (receive(message)) {
      if (message.tag == kHello) greet(message);
      if (message.tag != kResult) continue;
      --helpers[static_cast<std::size_t>(message.rank)].busy_with;
      hand_in(job, message.bytes);
    }
  }

  void greet(const Message& message) {
    Hello hello;
    std::memcpy(&hello, message.bytes.data(), sizeof(hello));
    const std::string text(message.bytes.begin() + sizeof(hello), message.bytes.end());
    const std::string difference =
        hello.threads > 0 ? first_difference(render::facts_from(text), facts) : text;
    if (difference.empty())
      helpers[static_cast<std::size_t>(message.rank)].threads = static_cast<std::size_t>(hello.threads);
    else
      warn("rank " + std::to_string(message.rank) + " cannot help: " + difference);
  }
};

Cluster::Cluster() : state_(std::make_unique<State>()) {
  join_ranks(state_->rank, state_->size);
  state_->helpers.resize(static_cast<std::size_t>(state_->size));
}

Cluster::~Cluster() {
  if (is_leader()) {
    // Results that are still on their way are of no use, but whoever sends one waits until it is taken.
    for (int rank = 1; rank < state_->size; ++rank) send(rank, kQuit);
    for (int left = state_->size - 1; left > 0;) {
      const Message message = wait_for_message();
      if (message.tag == kHello && state_->warn) state_->greet(message);
      left -= message.tag == kBye ? 1 : 0;
    }
  }
  leave_ranks();
}

bool Cluster::is_leader() const {
  return state_->rank == 0;
}

int Cluster::size() const {
  return state_->size;
}

RenderJob::Crew Cluster::crew(const RenderJob& job, std::function<void(const std::string&)> warn) {
  state_->facts = render::facts_of(job);
  state_->warn = std::move(warn);
  return [this](RenderJob& led, std::span<const Task> tasks) {
    if (tasks.empty()) return;
    // Tasks in order; when all are given out, those again that nobody has brought yet.
    std::size_t next = 0;
    const auto take = [&](std::size_t most) {
      std::vector<Task> taken;
      for (std::size_t looked = 0; looked < tasks.size() && taken.size() < most; ++looked, ++next) {
        const Task& task = tasks[next % tasks.size()];
        if (!led.film().has(task.unit.tile, task.index)) taken.push_back(task);
      }
      return taken;
    };

    Executor& executor = executor_of(led);
    const auto own_threads = static_cast<std::size_t>(executor.concurrency());
    while (!led.is_stopped()) {
      state_->serve(led);
      // How many each thread gets: several as long as many are left, then one by one.
      const auto share = [&] {
        std::size_t threads = own_threads;
        for (const State::Helper& helper : state_->helpers) threads += helper.threads;
        return render::tasks_at_once(tasks[0], tasks.size() - std::min(next, tasks.size()), threads);
      };
      // Each helper has a second message of tasks waiting, so that none waits for us.
      for (int rank = 1; rank < state_->size; ++rank) {
        State::Helper& helper = state_->helpers[static_cast<std::size_t>(rank)];
        if (helper.busy_with > helper.sent_last || helper.threads == 0) continue;
        // What others are at already is only for those who have nothing else to do.
        if (next >= tasks.size() && helper.busy_with > 0) continue;
        const std::vector<Task> taken = take(helper.threads * share());
        if (taken.empty()) return;
        std::vector<char> bytes;
        append(bytes, taken.data(), taken.size());
        send(rank, kTasks, bytes);
        helper.busy_with += taken.size();
        helper.sent_last = taken.size();
      }
      const std::vector<Task> own = take(own_threads * share());
      if (own.empty()) return;
      for_each_share(executor, own, [&](std::span<const Task> some) { led.render_and_add(some); });
    }
  };
}

void Cluster::help(const RenderJob& job) {
  Executor& executor = executor_of(job);
  say_hello({executor.concurrency()}, render::text_of(render::facts_of(job)));

  // Results wait for a leader who renders, too, while we go on with the tasks that are here already.
  Outbox outbox;
  for (Message message = wait_for_message(); message.tag != kQuit; message = wait_for_message()) {
    std::vector<Task> tasks(message.bytes.size() / sizeof(Task));
    std::memcpy(tasks.data(), message.bytes.data(), tasks.size() * sizeof(Task));
    std::vector<std::vector<char>> results(tasks.size());
    for_each_share(executor, tasks, [&](std::span<const Task> some) {
      const std::vector<render::UnitResult> brought = job.render(some);
      const auto first = static_cast<std::size_t>(some.data() - tasks.data());
      for (std::size_t i = 0; i < some.size(); ++i) results[first + i] = packed(some[i], brought[i]);
    });
    for (std::vector<char>& result : results) outbox.send(0, kResult, std::move(result));
  }
  outbox.wait_until_taken();
  send(0, kBye);
}

void Cluster::cannot_help(const std::string& why) {
  say_hello({0}, why);
  while (wait_for_message().tag != kQuit) {
  }
  send(0, kBye);
}

}  // namespace boxwood::app

#else

namespace boxwood::app {

struct Cluster::State {};

Cluster::Cluster() {
  throw std::runtime_error(
      "mpirun started several of this program, but it was built without Open MPI and they could not share "
      "the work (Debian: libopenmpi-dev)");
}

Cluster::~Cluster() = default;

bool Cluster::is_leader() const {
  return true;
}

int Cluster::size() const {
  return 1;
}

render::RenderJob::Crew Cluster::crew(const render::RenderJob&, std::function<void(const std::string&)>) {
  return {};
}

void Cluster::help(const render::RenderJob&) {}

void Cluster::cannot_help(const std::string&) {}

}  // namespace boxwood::app

#endif

// rank_mail.h: how do ranks send each other bytes?
//
// What cluster.cpp needs of Open MPI, and the only files that know it; without it there is nothing here.
#pragma once

#include <list>
#include <vector>

namespace boxwood::app {

/// Joins the other ranks, before anything is sent; on the main thread, where all else here is called, too.
void join_ranks(int& rank, int& size);
/// After everything was received.
void leave_ranks();

struct Message {
  int rank = 0, tag = 0;  ///< From whom, and what about.
  std::vector<char> bytes;
};

/// The next message, if one has arrived.
bool receive(Message& message);

/// The same, but waits for one, and leaves the processor to others meanwhile.
Message wait_for_message();

/// Sends, and may wait until the other rank receives.
void send(int rank, int tag, const std::vector<char>& bytes = {});

/// Messages that leave while the sender goes on; their bytes stay here until they were taken.
class Outbox {
 public:
  Outbox();
  ~Outbox();
  Outbox(const Outbox&) = delete;

  void send(int rank, int tag, std::vector<char> bytes);
  void wait_until_taken();

 private:
  struct Letter;
  void drop_taken();
  std::list<Letter> letters_;  // none of them may move
};

}  // namespace boxwood::app

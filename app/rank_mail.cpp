#ifdef BOXWOOD_HAS_MPI

#include "rank_mail.h"

#include <chrono>
#include <thread>

#define OMPI_SKIP_MPICXX 1
#include <mpi.h>

namespace boxwood::app {
namespace {

/// Leaves the processor to others for a moment, as what waits inside of MPI would not.
void pause() {
  std::this_thread::sleep_for(std::chrono::microseconds(200));
}

}  // namespace

void join_ranks(int& rank, int& size) {
  int provided = 0;
  MPI_Init_thread(nullptr, nullptr, MPI_THREAD_FUNNELED, &provided);
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  MPI_Comm_size(MPI_COMM_WORLD, &size);
}

void leave_ranks() {
  MPI_Finalize();
}

bool receive(Message& message) {
  int is_there = 0, size = 0;
  MPI_Status status;
  MPI_Iprobe(MPI_ANY_SOURCE, MPI_ANY_TAG, MPI_COMM_WORLD, &is_there, &status);
  if (!is_there) return false;
  MPI_Get_count(&status, MPI_BYTE, &size);
  message = {status.MPI_SOURCE, status.MPI_TAG, std::vector<char>(static_cast<std::size_t>(size))};
  MPI_Recv(message.bytes.data(), size, MPI_BYTE, message.rank, message.tag, MPI_COMM_WORLD,
           MPI_STATUS_IGNORE);
  return true;
}

Message wait_for_message() {
  Message message;
  while (!receive(message)) pause();
  return message;
}

void send(int rank, int tag, const std::vector<char>& bytes) {
  MPI_Send(bytes.data(), static_cast<int>(bytes.size()), MPI_BYTE, rank, tag, MPI_COMM_WORLD);
}

struct Outbox::Letter {
  std::vector<char> bytes;
  MPI_Request request;
};

Outbox::Outbox() = default;

Outbox::~Outbox() = default;

void Outbox::wait_until_taken() {
  for (drop_taken(); !letters_.empty(); drop_taken()) pause();
}

void Outbox::send(int rank, int tag, std::vector<char> bytes) {
  drop_taken();
  Letter& letter = letters_.emplace_back(Letter{std::move(bytes), MPI_REQUEST_NULL});
  MPI_Isend(letter.bytes.data(), static_cast<int>(letter.bytes.size()), MPI_BYTE, rank, tag, MPI_COMM_WORLD,
            &letter.request);
}

void Outbox::drop_taken() {
  for (int is_taken = 1; is_taken && !letters_.empty();) {
    MPI_Test(&letters_.front().request, &is_taken, MPI_STATUS_IGNORE);
    if (is_taken) letters_.pop_front();
  }
}

}  // namespace boxwood::app

#endif

/**
 * @file
 * The bench's end of the plant: several clients, a line each way, and never a wait.
 */
#ifndef INTERLOCK_PLANT_SIM_CONTROL_SERVER_HPP
#define INTERLOCK_PLANT_SIM_CONTROL_SERVER_HPP

#include <poll.h>

#include <span>
#include <vector>

#include "plant/sim/bus_server.hpp"
#include "plant/sim/protocol.hpp"

namespace interlock::plant::sim {

/** One connection to the control socket. */
class ControlClient {
 public:
  explicit ControlClient(FileDescriptor socket) : socket_(std::move(socket)) {}

  pollfd descriptor() const;

  /** Does a bounded piece of what is due: reads, answers one request, or writes a part of a long answer. */
  void serve(const pollfd& ready, Plant& plant, const BusServer& bus);

  /** True when `serve` has something to do without any news from the socket. */
  bool has_work() const;

  /** True when nobody is there any more and everything received was acted on. */
  bool is_done() const;

 private:
  void receive();
  void answer_line(Plant& plant, const BusServer& bus);
  void act(const Request& request, Plant& plant, const BusServer& bus);
  void answer_due_queries(Plant& plant, const BusServer& bus);
  void answer_query(const Request& request, Plant& plant, const BusServer& bus);
  void transmit();
  void give_up();
  bool has_line() const { return received_.find('\n') != std::string::npos; }
  bool may_answer() const;

  FileDescriptor socket_;
  std::string received_;
  std::string unsent_;
  std::vector<Request> waiting_;
  std::optional<RecordAnswer> long_answer_;
  bool discarding_ = false;
  bool ended_ = false;
  bool gone_ = false;
};

class ControlServer {
 public:
  ControlServer(Listener listener, Plant& plant, const BusServer& bus);

  /** Adds the descriptors to wait for. */
  void add_descriptors(std::vector<pollfd>& descriptors) const;

  /** Does a bounded piece of what is due, without waiting; `ready` is what `add_descriptors` added, polled.
   */
  void serve(std::span<const pollfd> ready);

  /** True when `serve` should be called again without waiting for news. */
  bool has_work() const;

 private:
  void accept_client();

  Listener listener_;
  Plant& plant_;
  const BusServer& bus_;
  std::vector<ControlClient> clients_;
};

}  // namespace interlock::plant::sim

#endif

/**
 * @file
 * The app's end of the link: attaches to the kernel, reads its snapshots and events, writes requests.
 *
 * The kernel hands over two memory regions (interlock/link.h). The app can only read the first and is the
 * only writer of the second. A `LinkClient` belongs to one thread; after `attach` no call allocates, locks or
 * throws.
 */
#pragma once

#include <chrono>
#include <cstdint>
#include <string>
#include <tl/expected.hpp>

#include "interlock/link.h"
#include "link/link_error.hpp"
#include "link/shared_mapping.hpp"

namespace interlock {

/** How a wait for the kernel's next snapshot ended. */
enum class LinkWait {
  snapshot, /**< a snapshot that was not read yet is there */
  timeout,  /**< none came in time; the attachment still stands */
  closed    /**< the attachment is over: the kernel closed it or died */
};

/** One attachment at a time to the kernel behind a socket path. */
class LinkClient {
 public:
  explicit LinkClient(std::string socket_path) : path_(std::move(socket_path)) {}

  /**
   * One attempt to attach, bounded by `hello_timeout`. An earlier attachment is dropped first.
   *
   * Refuses a kernel whose magic, version, layout or sizes differ, and memory that could shrink under the
   * reader.
   */
  tl::expected<void, LinkError> attach(std::chrono::milliseconds hello_timeout);

  /** Ends the attachment; the kernel sees the socket close. */
  void detach() noexcept;

  [[nodiscard]] bool attached() const noexcept { return kernel_ != nullptr; }

  /** Number of the attachment, as the kernel counts; 0 when there is none. */
  [[nodiscard]] std::uint32_t generation() const noexcept { return generation_; }

  /** Sleeps until the kernel publishes a snapshot newer than the last one read. */
  [[nodiscard]] LinkWait wait(std::chrono::milliseconds timeout) noexcept;

  /** Copies the newest whole snapshot; false when none was published or the writer was faster than every
   * retry. */
  [[nodiscard]] bool read_snapshot(ilk_snapshot_t& snapshot) noexcept;

  /** Takes the next event out of the ring; false when every event was read. */
  [[nodiscard]] bool read_event(ilk_event_t& event) noexcept;

  /** Events of this attachment that were overwritten before they could be read. */
  [[nodiscard]] std::uint32_t events_lost() const noexcept { return events_lost_; }

  /**
   * Numbers, seals and writes one request.
   *
   * @return its sequence number, or 0 when the ring holds no free record: nothing unread is ever overwritten.
   */
  [[nodiscard]] std::uint32_t send(ilk_request_t request) noexcept;

  /** Number of the newest request of this attachment, 0 when there is none. */
  [[nodiscard]] std::uint32_t last_sequence() const noexcept { return sequence_; }

  /** Tells the kernel which tick was handled; in the simulated clock it waits for that. */
  void publish_seen(std::uint32_t tick) noexcept;

 private:
  tl::expected<void, LinkError> adopt(const ilk_link_hello_t& hello, FileDescriptor kernel,
                                      FileDescriptor app);
  [[nodiscard]] bool peer_alive() const noexcept;

  std::string path_;
  FileDescriptor socket_;
  SharedMapping kernel_mapping_;
  SharedMapping app_mapping_;
  const ilk_link_kernel_region_t* kernel_ = nullptr;
  ilk_link_app_region_t* app_ = nullptr;
  std::uint32_t generation_ = 0;
  std::uint32_t sequence_ = 0;
  std::uint32_t events_read_ = 0;
  std::uint32_t events_lost_ = 0;
  std::uint32_t lock_read_ = 0;
};

}  // namespace interlock

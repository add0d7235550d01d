/**
 * @file
 * A Unix socket that listens at a path.
 */
#ifndef INTERLOCK_PLANT_SIM_LISTENER_HPP
#define INTERLOCK_PLANT_SIM_LISTENER_HPP

#include <sys/types.h>

#include <filesystem>
#include <string>
#include <tl/expected.hpp>

#include "plant/sim/file_descriptor.hpp"

namespace interlock::plant::sim {

/** Removes its path when it goes, unless another file is there by then. */
class Listener {
 public:
  /**
   * Listens, readable by this user only. A socket that a dead process left behind is replaced.
   *
   * @param type SOCK_SEQPACKET or SOCK_STREAM
   * @return or why not: path too long, somebody listens there, or the system's reason
   */
  static tl::expected<Listener, std::string> open(const std::filesystem::path& path, int type);

  Listener(Listener&& other) noexcept;
  Listener& operator=(Listener&&) = delete;
  ~Listener();

  int descriptor() const { return socket_.get(); }

  /** A client that waits; a closed descriptor when there is none. Never waits itself. */
  FileDescriptor accept() const;

 private:
  Listener(FileDescriptor socket, std::filesystem::path path, dev_t device, ino_t inode);

  FileDescriptor socket_;
  std::filesystem::path path_;
  dev_t device_;
  ino_t inode_;
};

}  // namespace interlock::plant::sim

#endif

#include "link/link_error.hpp"

namespace interlock {
namespace {

const char* next_step(LinkError::Kind kind) {
  switch (kind) {
    case LinkError::Kind::unreachable:
      return "start interlock-kernel with this --link socket";
    case LinkError::Kind::silent:
      return "look at the kernel's log; it should send its hello at once";
    case LinkError::Kind::incompatible:
      return "install interlock-app and interlock-kernel from the same build";
    case LinkError::Kind::broken:
      return "check that an interlock-kernel serves this socket";
  }
  return "look at the kernel's log";
}

}  // namespace

std::string LinkError::message() const { return detail + "; " + next_step(kind); }

}  // namespace interlock

#include "cli/free_port.hpp"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include <cerrno>
#include <string>
#include <system_error>

#include "system/file_descriptor.hpp"

namespace interlock::cli {

Result<std::uint16_t> free_port(std::uint16_t port) {
  const FileDescriptor listener(socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0));
  const int reuse = 1;
  setsockopt(listener.get(), SOL_SOCKET, SO_REUSEADDR, &reuse, sizeof reuse);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  address.sin_port = htons(port);
  socklen_t size = sizeof address;
  if (bind(listener.get(), reinterpret_cast<const sockaddr*>(&address), size) != 0 ||
      listen(listener.get(), 1) != 0 ||
      getsockname(listener.get(), reinterpret_cast<sockaddr*>(&address), &size) != 0) {
    return failed(ExitCode::precondition, "port " + std::to_string(port) + " of 127.0.0.1 cannot be used: " +
                                              std::generic_category().message(errno) +
                                              "; stop what listens there, or choose another --port");
  }
  return ntohs(address.sin_port);
}

}  // namespace interlock::cli

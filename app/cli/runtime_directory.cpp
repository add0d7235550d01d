#include "cli/runtime_directory.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/un.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <system_error>
#include <utility>

namespace interlock::cli {
namespace {

namespace fs = std::filesystem;

bool fits_socket_address(const fs::path& path) {
  return path.native().size() < sizeof(sockaddr_un::sun_path);
}

Failure too_long(const fs::path& path) {
  return {ExitCode::precondition, "the path of the socket " + path.string() +
                                      " is too long; expected less than " +
                                      std::to_string(sizeof(sockaddr_un::sun_path)) +
                                      " bytes: choose a shorter $XDG_RUNTIME_DIR or --sockets"};
}

}  // namespace

Result<RuntimeDirectory> RuntimeDirectory::make_private(const std::string& robot_name) {
  const char* const given = std::getenv("XDG_RUNTIME_DIR");
  const fs::path parent = given && *given == '/' ? fs::path(given) : fs::temp_directory_path();
  std::string pattern = parent / ("interlock-" + robot_name + "-XXXXXX");
  if (!mkdtemp(pattern.data())) {
    return failed(ExitCode::precondition, "no private directory can be made in " + parent.string() + ": " +
                                              std::generic_category().message(errno) +
                                              "; set XDG_RUNTIME_DIR to a directory of yours");
  }
  RuntimeDirectory directory(pattern, robot_name, UniqueFd());
  if (!fits_socket_address(directory.control())) {
    return tl::unexpected(too_long(directory.control()));
  }
  return directory;
}

Result<RuntimeDirectory> RuntimeDirectory::use(const fs::path& directory, const std::string& robot_name) {
  std::error_code ignored;
  const fs::path absolute = fs::absolute(directory);
  fs::create_directories(absolute, ignored);
  UniqueFd hold(open(absolute.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  if (!hold || flock(hold.get(), LOCK_EX | LOCK_NB) != 0) {
    const std::string reason =
        errno == EWOULDBLOCK ? "another instance uses it" : std::generic_category().message(errno);
    return failed(ExitCode::precondition, absolute.string() + " cannot be used for the sockets: " + reason +
                                              "; choose another directory with --sockets");
  }
  RuntimeDirectory given(absolute, robot_name, std::move(hold));
  if (!fits_socket_address(given.control())) {
    return tl::unexpected(too_long(given.control()));
  }
  given.remove_own_files();
  return given;
}

RuntimeDirectory::RuntimeDirectory(RuntimeDirectory&& other) noexcept
    : path_(std::exchange(other.path_, {})),
      robot_name_(std::move(other.robot_name_)),
      hold_(std::move(other.hold_)) {}

RuntimeDirectory::~RuntimeDirectory() {
  if (path_.empty()) {
    return;
  }
  if (is_private()) {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  } else {
    remove_own_files();
  }
}

void RuntimeDirectory::remove_own_files() const {
  for (const fs::path& file : {bus(), control(), link(), config()}) {
    std::error_code ignored;
    fs::remove(file, ignored);
  }
}

}  // namespace interlock::cli

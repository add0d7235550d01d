#include "cli/runtime_directory.hpp"

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
  RuntimeDirectory directory(pattern, robot_name);
  directory.removes_ = Removes::everything;
  if (!fits_socket_address(directory.black_box())) {
    return tl::unexpected(too_long(directory.black_box()));
  }
  return directory;
}

Result<RuntimeDirectory> RuntimeDirectory::use(const fs::path& directory, const std::string& robot_name) {
  std::error_code error;
  fs::create_directories(directory, error);
  if (error) {
    return failed(ExitCode::precondition, directory.string() + " cannot hold the sockets: " +
                                              error.message() + "; choose another directory with --sockets");
  }
  RuntimeDirectory given(fs::absolute(directory), robot_name);
  if (!fits_socket_address(given.black_box())) {
    return tl::unexpected(too_long(given.black_box()));
  }
  for (const fs::path& file : given.own_files()) {
    if (fs::symlink_status(file, error).type() != fs::file_type::not_found) {
      return failed(
          ExitCode::precondition,
          file.string() +
              " is there already: another instance uses the directory, or one that was killed left it; "
              "remove it, or choose another directory with --sockets");
    }
  }
  given.removes_ = Removes::own_files;
  return given;
}

RuntimeDirectory::RuntimeDirectory(RuntimeDirectory&& other) noexcept
    : path_(std::move(other.path_)),
      robot_name_(std::move(other.robot_name_)),
      removes_(std::exchange(other.removes_, Removes::nothing)) {}

RuntimeDirectory::~RuntimeDirectory() {
  std::error_code ignored;
  switch (removes_) {
    case Removes::nothing:
      break;
    case Removes::own_files:
      for (const fs::path& file : own_files()) {
        fs::remove(file, ignored);
      }
      break;
    case Removes::everything:
      fs::remove_all(path_, ignored);
      break;
  }
}

}  // namespace interlock::cli

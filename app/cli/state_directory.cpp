#include "cli/state_directory.hpp"

#include <cstdlib>

namespace interlock::cli {

namespace fs = std::filesystem;

Result<fs::path> state_directory(const fs::path& given, const std::string& robot_name) {
  if (!given.empty()) {
    return fs::absolute(given);
  }
  if (const char* const home = std::getenv("XDG_STATE_HOME"); home && *home == '/') {
    return fs::path(home) / "interlock" / robot_name;
  }
  if (const char* const home = std::getenv("HOME"); home && *home == '/') {
    return fs::path(home) / ".local/state/interlock" / robot_name;
  }
  return failed(ExitCode::precondition,
                "there is no place for the state: neither XDG_STATE_HOME nor HOME is set; use --state");
}

}  // namespace interlock::cli

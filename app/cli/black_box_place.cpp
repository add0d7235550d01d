#include "cli/black_box_place.hpp"

#include <unistd.h>

#include <string>
#include <system_error>

#include "store/digest.hpp"

namespace interlock::cli {

namespace fs = std::filesystem;

fs::path black_box_file(const fs::path& state) {
  std::error_code error;
  const fs::path place = fs::weakly_canonical(fs::absolute(state), error);
  const std::string name = sha256_hex((error ? state : place).string()).substr(0, 16);
  return "/dev/shm/interlock-" + std::to_string(geteuid()) + '-' + name + ".ring";
}

fs::path recordings_folder(const fs::path& state) { return state / "recordings"; }

}  // namespace interlock::cli

#include "cli/write_file.hpp"

#include <fstream>

namespace interlock::cli {

Result<void> write_file(const std::filesystem::path& file, const std::string& text) {
  if (file.empty()) {
    return {};
  }
  std::ofstream output(file, std::ios::binary);
  output << text;
  output.close();
  if (!output) {
    return failed(ExitCode::precondition, file.string() + ": cannot be written; choose another file");
  }
  return {};
}

}  // namespace interlock::cli

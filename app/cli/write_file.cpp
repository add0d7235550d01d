#include "cli/write_file.hpp"

#include <array>
#include <fstream>

#include "robot/compile.hpp"
#include "robot/robot_file.hpp"

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

Result<void> write_robot_file(const std::filesystem::path& file, const std::string& text) {
  if (file.empty()) {
    return {};
  }
  return parse_robot(text, file.string())
      .and_then([](const Robot& robot) { return compile(robot); })
      .map_error(robot_failure)
      .and_then([&](const ilk_config_t&) { return write_file(file, text); });
}

Result<std::string> text_of_file(const std::filesystem::path& file, const std::string& what) {
  constexpr std::size_t most_bytes = std::size_t{64} << 20;
  std::ifstream input(file, std::ios::binary);
  std::string text;
  std::array<char, 1 << 16> part{};
  while (input && text.size() <= most_bytes && !std::filesystem::is_directory(file)) {
    input.read(part.data(), part.size());
    text.append(part.data(), static_cast<std::size_t>(input.gcount()));
  }
  if (!input.eof()) {
    return failed(ExitCode::precondition,
                  file.string() + ": cannot be read, or is larger than 64 MiB; choose a file with " + what);
  }
  return text;
}

bool is_same_file(const std::filesystem::path& one, const std::filesystem::path& other) {
  std::error_code ignored;
  return !one.empty() && !other.empty() &&
         std::filesystem::weakly_canonical(one, ignored) == std::filesystem::weakly_canonical(other, ignored);
}

}  // namespace interlock::cli

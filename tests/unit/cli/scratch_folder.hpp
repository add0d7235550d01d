/** @file A folder of its own for each test. */
#pragma once

#include <gmock/gmock.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

namespace interlock::cli::test {

class ScratchFolder : public testing::Test {
 protected:
  ScratchFolder() {
    std::string pattern = std::filesystem::temp_directory_path() / "interlock-test-XXXXXX";
    folder_ = mkdtemp(pattern.data());
  }
  ~ScratchFolder() override { std::filesystem::remove_all(folder_); }

  /** Makes an empty file, and the folders above it. */
  std::filesystem::path touch(const std::filesystem::path& relative) const {
    const std::filesystem::path file = folder_ / relative;
    std::filesystem::create_directories(file.parent_path());
    std::ofstream stream(file);
    return file;
  }

  std::filesystem::path folder_;
};

}  // namespace interlock::cli::test

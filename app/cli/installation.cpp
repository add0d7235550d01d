#include "cli/installation.hpp"

#include <unistd.h>

namespace interlock::cli {

namespace fs = std::filesystem;

Installation Installation::current() {
  const fs::path programs = fs::read_symlink("/proc/self/exe").parent_path();
  fs::path installed = programs.parent_path() / "share/interlock";
  return {programs, fs::exists(installed) ? installed : programs.parent_path().parent_path().parent_path()};
}

Result<fs::path> Installation::program(const std::string& name) const {
  fs::path file = programs_ / name;
  if (access(file.c_str(), X_OK) != 0) {
    return failed(ExitCode::precondition, "there is no program " + file.string() +
                                              "; expected it beside interlock: build or install all of it");
  }
  return file;
}

Result<fs::path> Installation::robot(const std::string& robot) const {
  if (robot.ends_with(".toml") || robot.find('/') != std::string::npos) {
    return fs::path(robot);
  }
  return model("robots", robot);
}

std::vector<fs::path> Installation::robots() const {
  std::vector<fs::path> files;
  std::error_code none;
  for (const fs::directory_entry& entry : fs::directory_iterator(data_ / "models/robots", none)) {
    if (entry.path().extension() == ".toml") {
      files.push_back(entry.path());
    }
  }
  return files;
}

Result<fs::path> Installation::plant(const std::string& robot_name) const {
  return model("plant", robot_name);
}

Result<fs::path> Installation::model(const std::string& kind, const std::string& name) const {
  fs::path file = data_ / "models" / kind / (name + ".toml");
  if (!fs::exists(file)) {
    return failed(ExitCode::precondition,
                  "there is no " + kind + " file for \"" + name + "\"; looked for " + file.string());
  }
  return file;
}

std::optional<fs::path> Installation::web() const { return folder_with("assets", {"web", "web/dist"}); }

std::optional<fs::path> Installation::documents() const {
  return folder_with("index.html", {"documents", "build/docs/site"});
}

std::optional<fs::path> Installation::folder_with(const std::string& file,
                                                  std::array<const char*, 2> folders) const {
  for (const char* const folder : folders) {
    if (fs::exists(data_ / folder / file)) {
      return data_ / folder;
    }
  }
  return std::nullopt;
}

}  // namespace interlock::cli

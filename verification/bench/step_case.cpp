#include "step_case.hpp"

#include <array>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <nlohmann/json.hpp>

namespace interlock::bench {
namespace {

template <typename Record>
using Words = std::array<std::uint32_t, sizeof(Record) / sizeof(std::uint32_t)>;

template <typename Record>
nlohmann::json words_of(const Record& record) {
  Words<Record> words;
  std::memcpy(words.data(), &record, sizeof record);
  return words;
}

/// Throws nlohmann::json::exception or std::length_error.
template <typename Record>
Record record_of(const nlohmann::json& words, const char* what) {
  Words<Record> read;
  if (words.size() != read.size()) {
    throw std::length_error(std::string(what) + " has " + std::to_string(words.size()) + " words, expected " +
                            std::to_string(read.size()) + ": it was made by another version");
  }
  words.get_to(read);
  Record record;
  std::memcpy(&record, read.data(), sizeof record);
  return record;
}

}  // namespace

nlohmann::json json_of(const StepCase& step) {
  nlohmann::json requests = nlohmann::json::array();
  for (const ilk_request_t& request : step.requests) {
    requests.push_back(words_of(request));
  }
  return {{"config", words_of(step.config)},
          {"state", words_of(step.state)},
          {"inputs", words_of(step.inputs)},
          {"requests", requests}};
}

tl::expected<StepCase, std::string> read_step_case(const std::filesystem::path& path) {
  try {
    std::ifstream file(path);
    const nlohmann::json read = nlohmann::json::parse(file);
    StepCase step{record_of<ilk_config_t>(read.at("config"), "config"),
                  record_of<ilk_state_t>(read.at("state"), "state"),
                  record_of<ilk_inputs_t>(read.at("inputs"), "inputs"),
                  {}};
    for (const nlohmann::json& request : read.at("requests")) {
      step.requests.push_back(record_of<ilk_request_t>(request, "a request"));
    }
    return step;
  } catch (const std::exception& error) {
    return tl::unexpected(path.string() + ": " + error.what());
  }
}

}  // namespace interlock::bench

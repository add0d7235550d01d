/**
 * @file
 * What imagers said last, by OpenIGTLink: for people to see, with its age. Nothing is done by it.
 *
 * Belongs to the network thread.
 */
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "igtl/command.hpp"
#include "service/clocks.hpp"
#include "system/utc_time.hpp"

namespace interlock {

class Imager {
 public:
  /** Texts are cut behind as many bytes. */
  static constexpr std::size_t most_text_bytes = 1000;

  /** Keeps a word that came from the program of that address and port, in the place of the one before. */
  void hear(const igtl::ImagerWord& word, std::string client, UtcTime time, SteadyTime now);

  /** Schema `Imager` of spec/openapi.yaml. */
  [[nodiscard]] nlohmann::json to_json(SteadyTime now) const;

 private:
  template <typename Word>
  struct Heard {
    Word word;
    std::string client;
    UtcTime time;
    SteadyTime since;
  };

  std::optional<Heard<igtl::ImagerStatus>> status_;
  std::optional<Heard<igtl::TipPose>> tip_;
};

}  // namespace interlock

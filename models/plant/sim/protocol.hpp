/**
 * @file
 * The lines of the control socket: requests in, answers out. README.md is their specification.
 */
#ifndef INTERLOCK_PLANT_SIM_PROTOCOL_HPP
#define INTERLOCK_PLANT_SIM_PROTOCOL_HPP

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <tl/expected.hpp>
#include <variant>

#include "interlock/sim_bus.h"
#include "plant/plant.hpp"

namespace interlock::plant::sim {

struct StatusQuery {};

/** The newest image of the needle's tip. */
struct ImageQuery {};

/** Entries from the first to the last tick, both included. */
struct RecordQuery {
  std::uint64_t from;
  std::uint64_t to;
};

struct EventQuery {
  Event kind;
};

using Wish = std::variant<command::Command, StatusQuery, ImageQuery, RecordQuery, EventQuery>;

struct Request {
  nlohmann::json id;               /**< as in the line; null when there was none */
  std::optional<std::uint64_t> at; /**< plant tick at which it takes effect */
  Wish wish;
};

struct Refusal {
  nlohmann::json id;
  std::string reason;
};

/** Reads one line that came at plant tick `now`; any fault of it, an unknown field included, is a refusal. */
tl::expected<Request, Refusal> parse_request(std::string_view line, std::uint64_t now);

/** A line that accepts; `more` is an object whose fields are added. */
std::string accepted(const nlohmann::json& id, std::uint64_t tick,
                     nlohmann::json more = nlohmann::json::object());

/** A line that refuses. */
std::string refused(const Refusal& refusal);

/** All that a bench shows. `clock` is that of the attached kernel. */
nlohmann::json status_of(const Plant& plant, std::optional<ilk_clock_t> clock);

/** The answer to an image query; `image` is null before the first one. */
nlohmann::json image_of(const Plant& plant);

/** The answer to an event query: the tick, or null when it never happened. */
nlohmann::json newest_of(const Plant& plant, Event kind);

/**
 * The answer to a record query, written piece by piece so that a long one does not hold up the bus.
 *
 * At most `kMostEntries` entries; `next` then names the tick to go on from.
 */
class RecordAnswer {
 public:
  static constexpr std::uint64_t kMostEntries = 20'000;

  RecordAnswer(const nlohmann::json& id, const Plant& plant, const RecordQuery& query);

  /** Appends up to `most` entries to `text`; true when the answer is complete. */
  bool append(const Record& record, std::uint64_t most, std::string& text);

 private:
  std::string head_;
  std::uint64_t next_;
  std::uint64_t end_;
};

}  // namespace interlock::plant::sim

#endif

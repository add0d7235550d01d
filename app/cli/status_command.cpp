#include <iomanip>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string_view>

#include "cli/commands.hpp"
#include "cli/http_get.hpp"
#include "robot/catalog.hpp"

namespace interlock::cli {
namespace {

using namespace std::chrono_literals;
using catalog::Family;
using nlohmann::json;

constexpr auto answer_timeout = 5s;

class Table {
 public:
  void row(std::string_view title, const std::string& text) {
    stream_ << std::left << std::setw(12) << title << text << '\n';
  }

  /** A code with what the catalog says of it. */
  void code(std::string_view title, Family family, const std::string& name) {
    const catalog::Entry* const entry = catalog::find(family, name);
    row(title, entry ? name + ": " + std::string(entry->meaning) : name);
    if (entry && !entry->next_step.empty()) {
      row("", "Next: " + std::string(entry->next_step));
    }
  }

  [[nodiscard]] std::string text() const { return stream_.str(); }

 private:
  std::ostringstream stream_;
};

std::string text_of(const json& status, const char* key) { return status.at(key).get<std::string>(); }

std::string hardware_of(const json& status) {
  std::string text = status.at("simulated").get<bool>() ? "simulated hardware" : "real hardware";
  text += ", " + text_of(status, "clock") + " clock";
  return text + (status.at("degraded").get<bool>() ? ", degraded: no real-time rights" : "");
}

std::string host_of(const json& late) {
  std::ostringstream text;
  text << std::fixed << std::setprecision(1) << "late by " << late.at("now_ms").get<double>()
       << " ms now, by " << late.at("worst_ms").get<double>() << " ms at worst, by "
       << late.at("total_ms").get<std::uint64_t>() << " ms in all";
  return text.str();
}

std::string age_of(const json& status) {
  std::ostringstream text;
  text << std::fixed << std::setprecision(1) << status.at("age_ms").get<double>() << " ms at tick "
       << status.at("tick").get<std::uint64_t>();
  return text.str();
}

std::string power_of(const json& status) {
  const std::string power = text_of(status, "power");
  return power == "coming_up" ? "coming up" : power;
}

std::string card_text(const json& card) {
  return "slot " + std::to_string(card.at("slot").get<int>()) + ' ' + text_of(card, "card") +
         (card.at("detected").get<bool>() ? ", detected" : ", NOT DETECTED") + ", " +
         std::to_string(card.at("checksum_failures").get<std::uint64_t>()) + " checksum failures";
}

std::string table_of(const json& status) {
  Table table;
  table.row("Interlock", text_of(status, "version") + ", commit " + text_of(status, "commit"));
  table.row("Robot", text_of(status, "robot") + ", configuration " + text_of(status, "config_crc"));
  table.row("Hardware", hardware_of(status));
  if (!status.at("connected").get<bool>()) {
    table.row("Kernel", "NOT CONNECTED");
    return table.text();
  }
  table.code("Mode", Family::mode, text_of(status, "mode"));
  if (text_of(status, "mode") == "LOCKED") {
    table.code("Cause", Family::cause, text_of(status, "cause"));
  }
  table.row("E-stop", status.at("estop").get<bool>() ? "ACTIVE" : "clear");
  table.row("Pedal",
            text_of(status, "pedal") + (status.at("pedal_armed").get<bool>() ? ", armed" : ", not armed"));
  table.row("Power", power_of(status));
  table.row("Data", age_of(status));
  if (const json& late = status.at("host_late"); !late.is_null()) {
    table.row("Host", host_of(late));
  }
  for (const json& card : status.at("cards")) {
    table.row("Card", card_text(card));
  }
  return table.text();
}

}  // namespace

Result<std::string> status_table(const std::string& body) {
  try {
    return table_of(json::parse(body));
  } catch (const json::exception& error) {
    return failed(ExitCode::no_answer,
                  std::string("the answer is not the status of an interlock-app: ") + error.what() +
                      "; expected the Status of spec/openapi.yaml from the same version");
  }
}

Result<void> show_status(const StatusOptions& options, std::ostream& output) {
  const Result<HttpAnswer> answer = http_get(options.port, "/api/status", answer_timeout);
  if (!answer) {
    return tl::unexpected(answer.error());
  }
  if (answer->status != 200) {
    return failed(ExitCode::no_answer, "port " + std::to_string(options.port) +
                                           " answered with HTTP status " + std::to_string(answer->status) +
                                           "; expected an interlock-app there");
  }
  if (options.json) {
    output << answer->body << '\n';
    return {};
  }
  const Result<std::string> table = status_table(answer->body);
  if (!table) {
    return tl::unexpected(table.error());
  }
  output << *table;
  return {};
}

}  // namespace interlock::cli

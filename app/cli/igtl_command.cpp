#include <CLI/CLI.hpp>
#include <chrono>
#include <cstdio>
#include <optional>
#include <ostream>

#include "cli/commands.hpp"
#include "cli/igtl_words.hpp"
#include "igtl/client.hpp"

namespace interlock::cli {
namespace {

using Clock = std::chrono::steady_clock;
using igtl::Client;
using igtl::Message;

constexpr double usual_send_seconds = 1.0;
constexpr double usual_phase_seconds = 6.0;
constexpr std::chrono::seconds connect_timeout{5};
constexpr std::size_t prefix_width = 4;

Clock::time_point in_seconds(double seconds) {
  return Clock::now() + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(seconds));
}

std::string place_of(const IgtlOptions& options) { return options.host + ":" + std::to_string(options.port); }

tl::unexpected<Failure> lost(const IgtlOptions& options, const std::string& reason) {
  return failed(ExitCode::no_answer, "OpenIGTLink at " + place_of(options) + ": " + reason +
                                         "; start a robot with interlock run --igtl-port, or name its --host "
                                         "and --port");
}

Result<void> connect(Client& client, const IgtlOptions& options) {
  const auto connected = client.connect(options.host, options.port, Clock::now() + connect_timeout);
  return connected ? Result<void>() : lost(options, connected.error());
}

void print(const Message& message, const IgtlOptions& options, const std::string& before,
           std::ostream& output) {
  output << (options.json ? igtl_json(message).dump() : before + igtl_line(message)) << std::endl;
}

/** Messages until one that ends it, or until the deadline: false then. */
template <typename Ends>
Result<bool> follow(Client& client, const IgtlOptions& options, Clock::time_point deadline, Ends ends) {
  for (;;) {
    const auto message = client.receive(deadline);
    if (!message) {
      return lost(options, message.error());
    }
    if (!*message) {
      return false;
    }
    if (ends(**message)) {
      return true;
    }
  }
}

const igtl::Status* refusal_in(const Message& message) {
  const auto* status = std::get_if<igtl::Status>(&message.body);
  return status != nullptr && status->code != igtl::StatusCode::ok ? status : nullptr;
}

/** What the robot answers to a name: the same, or ACK_ and the ID. */
bool answers(const Message& message, const std::string& name) {
  const bool has_id = name.size() > prefix_width && name[prefix_width - 1] == '_';
  return message.device == name || (has_id && message.device == "ACK_" + name.substr(prefix_width));
}

Result<void> send(const IgtlOptions& options, std::ostream& output) {
  const auto body = igtl_body(options.type, options.values);
  if (!body) {
    return tl::unexpected(body.error());
  }
  Client client;
  if (const auto opened = connect(client, options); !opened) {
    return opened;
  }
  const auto deadline = in_seconds(options.seconds > 0.0 ? options.seconds : usual_send_seconds);
  if (const auto sent = client.send(options.name, *body, deadline); !sent) {
    return lost(options, sent.error());
  }
  std::optional<std::string> refused;
  const auto answered = follow(client, options, deadline, [&](const Message& message) {
    if (!answers(message, options.name)) {
      return false;
    }
    print(message, options, "", output);
    const igtl::Status* const status = refusal_in(message);
    const bool is_asked_for = options.type == "get" && options.values[0] == "STATUS";
    if (status != nullptr && !is_asked_for) {
      refused = status->text;
    }
    return true;
  });
  if (!answered) {
    return tl::unexpected(answered.error());
  }
  if (!*answered && options.type != "status") {
    return lost(options, "nothing was answered under the name " + options.name);
  }
  return refused ? failed(ExitCode::refused, options.name + " was refused: " + *refused) : Result<void>();
}

Result<void> listen(const IgtlOptions& options, std::ostream& output) {
  Client client;
  if (const auto opened = connect(client, options); !opened) {
    return opened;
  }
  const auto deadline = options.seconds > 0.0 ? in_seconds(options.seconds) : Clock::time_point::max();
  std::uint32_t printed = 0;
  const auto ended = follow(client, options, deadline, [&](const Message& message) {
    if (options.only.empty() || options.only == message.device) {
      print(message, options, "", output);
      ++printed;
    }
    return options.count != 0 && printed == options.count;
  });
  if (!ended) {
    return tl::unexpected(ended.error());
  }
  return printed == 0 ? lost(options, "nothing came") : Result<void>();
}

std::string milliseconds_since(Clock::time_point asked) {
  const std::chrono::duration<double, std::milli> passed = Clock::now() - asked;
  std::array<char, 32> text{};
  (void)std::snprintf(text.data(), text.size(), "%8.1f ms  ", passed.count());
  return text.data();
}

/** An ERROR of another code tells of the kernel, whatever was asked: that it is locked, when the robot has
 * just started. */
bool is_unknown_phase(const Message& message) {
  const igtl::Status* const status = refusal_in(message);
  return message.device == "ERROR" && status != nullptr &&
         status->code == igtl::StatusCode::unknown_instruction;
}

Result<void> drive(Client& client, const IgtlOptions& options, const std::string& phase,
                   std::ostream& output) {
  const auto deadline = in_seconds(options.seconds > 0.0 ? options.seconds : usual_phase_seconds);
  const auto asked = Clock::now();
  if (const auto sent = client.send("CMD_" + options.id, igtl::Text{phase}, deadline); !sent) {
    return lost(options, sent.error());
  }
  bool is_entered = false;
  std::optional<std::string> refused;
  const auto ended = follow(client, options, deadline, [&](const Message& message) {
    const igtl::Status* const status = refusal_in(message);
    const bool is_current = message.device == "CURRENT_STATUS";
    const bool is_last = message.device == phase || is_unknown_phase(message);
    if (is_current || is_last || message.device == "ACK_" + options.id) {
      print(message, options, milliseconds_since(asked), output);
    }
    is_entered = is_entered || (is_current && status == nullptr);
    if (is_last && status != nullptr && status->code != igtl::StatusCode::busy) {
      refused = status->text;
    }
    return is_last && (status == nullptr || refused);
  });
  if (!ended) {
    return tl::unexpected(ended.error());
  }
  if (refused) {
    return failed(ExitCode::refused, "the phase " + phase + " was refused: " + *refused);
  }
  if (!*ended && !is_entered) {
    return lost(options,
                "the phase " + phase + " was not answered; does the robot speak brp2013 or wpi2024?");
  }
  return {};
}

Result<void> drive_all(const IgtlOptions& options, std::ostream& output) {
  Client client;
  if (const auto opened = connect(client, options); !opened) {
    return opened;
  }
  for (const std::string& phase : options.phases) {
    if (const auto driven = drive(client, options, phase, output); !driven) {
      return driven;
    }
  }
  return {};
}

void add_place(CLI::App& command, IgtlOptions& options, const char* wait) {
  command.add_option("--host", options.host, "Name or address of the robot's machine")->capture_default_str();
  command.add_option("--port", options.port, "Its port for OpenIGTLink")->capture_default_str();
  command.add_option("--wait", options.seconds, wait)->check(CLI::PositiveNumber);
  command.add_flag("--json", options.json, "One JSON object a message");
}

}  // namespace

void add_igtl(CLI::App& cli, IgtlOptions& options) {
  CLI::App* const igtl = cli.add_subcommand("igtl", "Speak OpenIGTLink to a robot, for trying things out");
  igtl->require_subcommand(1);
  CLI::App* const send = igtl->add_subcommand("send", "Send one message and show what is answered to it");
  send->add_option("TYPE", options.type, "transform, string, point, status or get")
      ->check(CLI::IsMember({"transform", "string", "point", "status", "get"}))
      ->required();
  send->add_option("NAME", options.name, "Device name: REGISTRATION, CMD_1")
      ->check(
          CLI::Validator([](std::string& name) { return name.size() > 20 ? "at most 20 characters" : ""; },
                         "up to 20 characters"))
      ->required();
  send->add_option("VALUE", options.values,
                   "transform: 3, 12 or 16 numbers, row by row; string: a text; point: 3 numbers; status: a "
                   "code and a text; get: a type");
  add_place(*send, options, "Seconds to wait for the answer; default 1");
  CLI::App* const listen = igtl->add_subcommand("listen", "Show what the robot tells, a line a message");
  listen->add_option("--name", options.only, "Messages of this name alone");
  listen->add_option("--count", options.count, "End after as many; default: go on");
  add_place(*listen, options, "Seconds after which it ends; default: go on");
  CLI::App* const phase =
      igtl->add_subcommand("phase", "Ask for workphases, and show the answers with their times");
  phase->add_option("PHASE", options.phases, "START_UP, PLANNING, ... one after the other")->required();
  phase->add_option("--id", options.id, "ID of the requests, up to 16 characters")->capture_default_str();
  add_place(*phase, options, "Seconds to wait for each phase's own STATUS; default 6");
}

Result<void> speak_igtl(const CLI::App& chosen, const IgtlOptions& options, std::ostream& output) {
  if (chosen.got_subcommand("send")) {
    return send(options, output);
  }
  return chosen.got_subcommand("listen") ? listen(options, output) : drive_all(options, output);
}

}  // namespace interlock::cli

/**
 * @file
 * interlock-app: shows the robot and proposes motion. It can be killed at any moment; the kernel stops motion
 * by itself.
 */
#include <pthread.h>
#include <spdlog/spdlog.h>
#include <sys/resource.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <boost/asio/io_context.hpp>
#include <boost/asio/signal_set.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/this_coro.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <csignal>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <stop_token>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "build_info/build_info.hpp"
#include "history/history_feed.hpp"
#include "http/server.hpp"
#include "igtl/stop_scout.hpp"
#include "interlock/kernel.h"
#include "log/log.hpp"
#include "motion/control_loop.hpp"
#include "proposals/motion_kind.hpp"
#include "robot/catalog.hpp"
#include "robot/compile.hpp"
#include "robot/robot_file.hpp"
#include "store/audit.hpp"
#include "store/first_admin.hpp"
#include "store/noted_heads.hpp"
#include "store/runs.hpp"
#include "store/settings.hpp"
#include "store/store.hpp"
#include "store/store_backup.hpp"
#include "system/capabilities.hpp"
#include "system/launch.hpp"
#include "system/service_manager.hpp"

namespace interlock {
namespace {

constexpr int exit_failed = 1;
constexpr int exit_unusable = 2;
constexpr std::chrono::seconds session_sweep_pause{1};
constexpr std::chrono::seconds head_report_pause{1};
/** For the network's thread to end after a signal. */
constexpr std::chrono::seconds longest_end{2};
constexpr int first_in_turn = -10; /**< as nice(1) counts */

struct Options {
  std::string robot_file;
  std::string config_file;
  std::string link_socket;
  std::string bench_socket;
  std::string black_box;
  web::Listen listen;
  std::string web_directory;
  std::string docs_directory;
  std::string state_directory;
  bool new_store = false; /**< in the place of one that is missing or damaged */
  std::string recorder;   /**< socket of the recorder, which notes the head of the audit */
  std::string audit_heads;
  std::string log_level = "info";
  std::optional<std::uint16_t> igtl_port; /**< in place of the robot file's */
  std::string igtl_dialect;               /**< in place of the robot file's, unless empty */
  bool replay = false;                    /**< a recording comes over the link */
};

/** The robot and the configuration that the kernel was started with. */
struct Model {
  Robot robot;
  ilk_config_t config{};
};

void describe(CLI::App& cli, Options& options) {
  cli.set_version_flag("--version", std::string(version()) + " " + std::string(commit()));
  cli.add_option("--robot", options.robot_file, "robot file (TOML)")->required();
  cli.add_option("--config", options.config_file, "compiled configuration that the kernel runs (*.ilkc)")
      ->required();
  cli.add_option("--link", options.link_socket, "the kernel's link socket")->required();
  cli.add_option("--bench", options.bench_socket, "control socket of the simulated hardware");
  cli.add_option("--black-box", options.black_box,
                 "socket on which the kernel hands out its black box, to show single ticks");
  cli.add_option("--listen", options.listen.address, "loopback address to serve on")->capture_default_str();
  cli.add_option("--port", options.listen.port, "port to serve on; 0: any free one")
      ->check(CLI::Range(0, 65535))
      ->capture_default_str();
  cli.add_option("--public-origin", options.listen.proxy.origin,
                 "https://NAME[:PORT] of the console behind a proxy with TLS on this machine");
  cli.add_option(
      "--trusted-proxy", options.listen.proxy.address,
      "address that the proxy connects from; its X-Forwarded-For names the client in log and audit");
  cli.add_option("--web", options.web_directory, "folder of the built console")
      ->check(CLI::ExistingDirectory);
  cli.add_option("--docs", options.docs_directory, "folder of the built documents")
      ->check(CLI::ExistingDirectory);
  cli.add_option("--state", options.state_directory, "folder of the store and the logs, made if missing")
      ->required();
  cli.add_flag("--new-store", options.new_store,
               "begin a new store, without users, where the one of an earlier run is missing or damaged");
  cli.add_option("--recorder", options.recorder, "socket on which the recorder notes the head of the audit");
  cli.add_option("--audit-heads", options.audit_heads,
                 "the recorder's file of heads that it noted, which the audit must contain");
  cli.add_option("--igtl-port", options.igtl_port,
                 "port for OpenIGTLink, in place of the robot file's; 0: any")
      ->check(CLI::Range(0, 65535));
  cli.add_option("--igtl-dialect", options.igtl_dialect,
                 "dialect of OpenIGTLink, in place of the robot file's: thesis, brp2013 or wpi2024")
      ->check(CLI::IsMember({"thesis", "brp2013", "wpi2024"}));
  cli.add_flag("--replay", options.replay,
               "a recording comes over the link: send nothing, and let nobody take control");
  cli.add_option("--log-level", options.log_level, "debug, info, warning, error or critical")
      ->check(CLI::IsMember({"debug", "info", "warning", "error", "critical"}))
      ->capture_default_str();
}

tl::expected<std::unique_ptr<Log>, std::string> start_log(const Options& options) {
  const std::filesystem::path folder = options.state_directory;
  return Log::start(folder.empty() ? folder : folder / "log" / "interlock-app.log",
                    log_level(options.log_level).value_or(LogLevel::info))
      .map_error(
          [&](const std::string& reason) { return "--state " + options.state_directory + ": " + reason; });
}

tl::expected<ilk_config_t, std::string> read_config(const std::string& file) {
  std::ifstream stream(file, std::ios::binary);
  ConfigBytes bytes{};
  stream.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  if (!stream || stream.peek() != std::ifstream::traits_type::eof()) {
    return tl::make_unexpected("--config " + file + ": expected a readable file of " +
                               std::to_string(bytes.size()) +
                               " bytes; make it with `interlock model compile`");
  }
  const ilk_config_t config = decode(bytes);
  const ilk_config_verdict_t verdict = ilk_config_validate(&config);
  if (verdict.error != ILK_CONFIG_ERROR_NONE) {
    return tl::make_unexpected(
        "--config " + file + ": slot " + std::to_string(verdict.slot) + ": " +
        std::string(catalog::entry(catalog::Family::config_error, verdict.error).meaning) +
        " Make it with `interlock model compile`");
  }
  return config;
}

tl::expected<Model, std::string> load_model(const Options& options) {
  const auto robot = load_robot(options.robot_file);
  if (!robot) {
    return tl::make_unexpected(robot.error().message());
  }
  const auto compiled = compile(*robot);
  if (!compiled) {
    return tl::make_unexpected(compiled.error().message());
  }
  const auto config = read_config(options.config_file);
  if (!config) {
    return tl::make_unexpected(config.error());
  }
  if (config->crc != compiled->crc) {
    return tl::make_unexpected("--config " + options.config_file + " has configuration " +
                               config_hash(*config) + ", but " + options.robot_file + " compiles to " +
                               config_hash(*compiled) + "; compile it again with `interlock model compile`");
  }
  return Model{*robot, *config};
}

std::string url_of(const web::Listen& listen, std::uint16_t port) {
  const bool v6 = listen.address.find(':') != std::string::npos;
  const std::string host = v6 ? "[" + listen.address + "]" : listen.address;
  return "http://" + host + ":" + std::to_string(port) + "/";
}

/** The store as an earlier run left it; a new one where that was the first, or where it is lost and
 * --new-store was given. */
Stored<Store> open_store(const Options& options) {
  const std::filesystem::path file = std::filesystem::path(options.state_directory) / store_file_name;
  Stored<NotedHeads> heads = read_noted_heads(options.audit_heads);
  if (!heads) {
    return tl::unexpected(heads.error());
  }
  Stored<Store> store = Store::open(file);
  if (const Stored<void> checked = store ? store->check(std::move(*heads)) : Stored<void>(); !checked) {
    store = tl::unexpected(checked.error());
  }
  if (!store && store.error().kind == StoreError::Kind::damaged && options.new_store) {
    std::cout << "a new store takes the place of the old one: " << store.error().problem << std::endl;
    const StoreError reason = store.error();
    return begin_new_store(file, reason, std::chrono::system_clock::now());
  }
  return store;
}

/** Gives the runs that an earlier app left unfinished. */
Stored<std::vector<std::int64_t>> record_start(Store& store, const Model& model) {
  return store.transact([&](Transaction& transaction) -> Stored<std::vector<std::int64_t>> {
    nlohmann::json detail{{"version", version()},
                          {"commit", commit()},
                          {"robot", model.robot.name},
                          {"config_crc", config_hash(model.config)}};
    const auto interrupted = Runs(transaction).interrupt("The app ended while it went on.");
    if (!interrupted.empty()) {
      detail["interrupted_runs"] = interrupted;
    }
    Audit(transaction)
        .append({std::chrono::system_clock::now(), std::nullopt, audit_actor::app, std::nullopt,
                 AuditKind::start, std::move(detail)});
    return interrupted;
  });
}

struct BegunStore {
  Store store;
  std::vector<std::int64_t> interrupted; /**< runs that an earlier app left unfinished */
};

/** The store, with the record of this start in it before there is a log: a store without a record beside logs
 * is one that was emptied. */
tl::expected<BegunStore, std::string> begin_store(const Options& options, const Model& model) {
  return open_store(options)
      .and_then([&](Store store) {
        return record_start(store, model).map([&](std::vector<std::int64_t> interrupted) {
          return BegunStore{std::move(store), std::move(interrupted)};
        });
      })
      .map_error([&](const StoreError& error) {
        return "--state " + options.state_directory + ": " + error.message();
      });
}

/** Shows the first administrator's password, this once and nowhere else, when there is no user yet. */
Stored<void> let_somebody_in(Store& store) {
  return add_first_admin(store, std::chrono::system_clock::now())
      .map([](const std::optional<Password>& password) {
        if (password) {
          std::cout << "first login: " << first_admin_name << ' ' << password->text() << std::endl;
        }
      });
}

/** Listens for navigation programs when the robot's file or the command line says so; they ask for motion, so
 * not in a replay. */
tl::expected<void, std::string> listen_for_navigation(const Options& options, const Robot& robot,
                                                      Navigation& navigation) {
  if (options.replay || (!robot.openigtlink && !options.igtl_port)) {
    return {};
  }
  const OpenIgtLink link = robot.openigtlink.value_or(OpenIgtLink{});
  const auto port = options.igtl_port.value_or(static_cast<std::uint16_t>(link.port));
  NavigationOptions desired{options.igtl_dialect.empty() ? link.dialect : options.igtl_dialect,
                            link.first_controls, std::nullopt};
  if (!link.connect_address.empty()) {
    boost::system::error_code error;
    const auto address = boost::asio::ip::make_address(link.connect_address, error);
    if (error) {
      return tl::make_unexpected(options.robot_file + ": [openigtlink] connect: \"" + link.connect_address +
                                 "\" is no address; expected one such as 10.0.0.7");
    }
    desired.connect = boost::asio::ip::tcp::endpoint(address, static_cast<std::uint16_t>(link.connect_port));
  }
  return navigation.server()
      .listen({link.bind, port, link.allow, std::chrono::milliseconds(link.heartbeat_ms)})
      .map([&] {
        navigation.start(std::move(desired));
        spdlog::info("OpenIGTLink listens on {}:{}", link.bind, navigation.server().port());
        std::cout << "OpenIGTLink " << link.bind << ':' << navigation.server().port() << std::endl;
      });
}

/** The network's thread says so, of the control thread and of that of the door: none may stand still. */
boost::asio::awaitable<void> tell_service_manager(ServiceManager& manager, const ControlLoop& control,
                                                  const RealtimeChannel& channel) {
  boost::asio::steady_timer timer(co_await boost::asio::this_coro::executor);
  std::uint32_t door = 0;
  while (manager.pause().count() > 0) {
    const std::uint32_t kept = channel.door_kept.load(std::memory_order_relaxed);
    if (std::exchange(door, kept) != kept) {
      manager.say_alive(control.rounds());
    }
    timer.expires_after(manager.pause());
    co_await timer.async_wait(boost::asio::use_awaitable);
  }
}

Stored<AuditHead> read_head(Store& store) {
  return store.read([](Transaction& transaction) -> Stored<AuditHead> { return Audit(transaction).head(); });
}

/** No proposal of an earlier run of the app has a number beyond it: each is preceded by a record of its own.
 * Records can be retired, so the runs count as well. */
Stored<std::int64_t> read_newest_proposal(Store& store) {
  return store.read([](Transaction& transaction) -> Stored<std::int64_t> {
    return std::max(Audit(transaction).newest_of(AuditKind::proposal), Runs(transaction).newest());
  });
}

Stored<std::optional<Setting>> read_holds(Store& store) {
  return store.read([](Transaction& transaction) -> Stored<std::optional<Setting>> {
    return Settings(transaction).find(HoldService::setting);
  });
}

/** Has the recorder note the head of the audit, soon after it has changed. */
boost::asio::awaitable<void> report_heads(StoreExecutor& store_executor, const std::string& recorder) {
  boost::asio::steady_timer timer(co_await boost::asio::this_coro::executor);
  AuditHead reported;
  while (!recorder.empty()) {
    const auto head = co_await store_executor.run(read_head);
    if (head && *head != reported && report_head(recorder, *head)) {
      reported = *head;
    }
    timer.expires_after(head_report_pause);
    co_await timer.async_wait(boost::asio::use_awaitable);
  }
}

/** As `top -H` shows the calling thread. */
void name_thread(const char* name) { pthread_setname_np(pthread_self(), name); }

/** Ends the app on a signal: a STOP first, which waits for no other thread, then the network's thread by
 * itself, or else the process. */
boost::asio::awaitable<void> end_on_signal(RealtimeChannel& channel, std::function<void()> end_network) {
  const auto executor = co_await boost::asio::this_coro::executor;
  boost::asio::signal_set signals(executor, SIGINT, SIGTERM);
  const int signal = co_await signals.async_wait(boost::asio::use_awaitable);
  channel.stop();
  spdlog::info("signal {}: ending", signal);
  end_network();
  boost::asio::steady_timer timeout(executor, longest_end);
  co_await timeout.async_wait(boost::asio::use_awaitable);
  spdlog::critical("the network's thread did not end");
  spdlog::default_logger()->flush();
  std::_Exit(exit_failed);
}

tl::expected<void, std::string> serve(const Options& options, const Model& model, BegunStore& begun,
                                      Log& log) {
  Store& store = begun.store;
  auto manager = ServiceManager::connect();
  if (!manager) {
    return tl::make_unexpected(manager.error());
  }
  boost::asio::io_context network(1);
  boost::asio::io_context door(1);
  const auto executor = network.get_executor();
  const auto channel = std::make_unique<RealtimeChannel>();
  StoreExecutor store_executor(executor, store);
  const RobotPlan plan(model.robot, model.config);
  HistoryFeed history(plan);
  web::Api api(executor, model.robot, model.config, *channel, options.bench_socket, store_executor, log, {},
               {&history, options.black_box});
  api.compare_with(options.audit_heads);
  if (const auto newest = read_newest_proposal(store)) {
    api.registry().number_after(static_cast<std::uint32_t>(*newest));
  }
  if (const auto kept = read_holds(store); kept && *kept && !options.replay) {
    api.restore_holds((*kept)->value);
  }
  for (const std::int64_t run : begun.interrupted) {
    api.alarms().note_ended_motion(run, "The app ended while it went on.");
  }
  web::Server server(door.get_executor(), executor, api, *channel,
                     web::StaticFiles(options.web_directory, options.docs_directory));
  if (auto listening = server.door().listen(options.listen); !listening) {
    return listening;
  }
  if (auto listening = listen_for_navigation(options, model.robot, api.navigation()); !listening) {
    return listening;
  }
  if (const auto let_in = let_somebody_in(store); !let_in) {
    return tl::make_unexpected("--state " + options.state_directory + ": " + let_in.error().message());
  }
  const auto stop_before_its_turn = [&] {
    channel->stop();
    spdlog::warn("STOP by OpenIGTLink, before its turn");
  };
  igtl::StopScout scout(door.get_executor(), stop_before_its_turn);
  api.navigation().server().on_stop_ahead = stop_before_its_turn;
  api.navigation().server().on_socket = [&](int socket, const std::weak_ptr<const void>& connection) {
    scout.watch(socket, connection);
  };
  ControlLoop control(options.link_socket, make_modes(plan), LinkageWatch(model.robot), *channel, &history,
                      options.replay ? LinkUse::replay : LinkUse::control);
  const std::jthread control_thread([&](const std::stop_token& stop) {
    name_thread("control");
    control.run(stop);
  });
  launch(executor, api.listen());
  launch(executor, api.broadcast());
  launch(executor, api.sweep_sessions(session_sweep_pause));
  launch(executor, report_heads(store_executor, options.recorder));
  launch(executor, tell_service_manager(*manager, control, *channel));
  launch(door.get_executor(), server.door().accept());
  launch(door.get_executor(), server.door().heartbeat());
  launch(door.get_executor(), server.door().listen_to_control());
  launch(door.get_executor(), end_on_signal(*channel, [&] {
           boost::asio::co_spawn(executor, api.release_pedal(),
                                 [&](const std::exception_ptr&) { network.stop(); });
         }));
  const std::string url = url_of(options.listen, server.port());
  spdlog::info("interlock-app {} {} serves {} at {}", version(), commit(), model.robot.name, url);
  std::cout << "ready " << url << std::endl;
  manager->say_ready();
  const std::jthread door_thread([&](const std::stop_token& stop) {
    name_thread("door");
    const std::stop_callback end(stop, [&] { door.stop(); });
    door.run();
  });
  network.run();
  return {};
}

[[noreturn]] void record_and_abort() noexcept {
  try {
    if (const auto thrown = std::current_exception()) {
      std::rethrow_exception(thrown);
    }
    spdlog::critical("terminated without an exception");
  } catch (const std::exception& error) {
    spdlog::critical("uncaught exception: {}", error.what());
  } catch (...) {
    spdlog::critical("uncaught exception of an unknown type");
  }
  spdlog::default_logger()->flush();
  std::abort();
}

/** While there is a log to hold the cause of an end that nobody expected. */
int serve_and_log(const Options& options, const Model& model, BegunStore& begun, Log& log) {
  try {
    const auto served = serve(options, model, begun, log);
    if (const Stored<AuditHead> head = read_head(begun.store); head && !options.recorder.empty()) {
      report_head(options.recorder, *head);
    }
    if (!served) {
      std::cerr << "interlock-app: " << served.error() << std::endl;
    }
    return served ? 0 : exit_unusable;
  } catch (const std::exception& error) {
    spdlog::critical("uncaught exception: {}", error.what());
    return exit_failed;
  }
}

/** An exception that nobody expected leaves the app in a state that nobody knows: it ends, to be started
 * anew. */
int run(const Options& options) {
  const auto unusable = [](const std::string& reason) {
    std::cerr << "interlock-app: " << reason << std::endl;
    return exit_unusable;
  };
  // Before the rest of a busy machine, where that is allowed: once the threads that people wait for stand
  // still, motion ends (`ControlLoop::watch_service`). Threads begin with the priority of this one.
  (void)setpriority(PRIO_PROCESS, 0, first_in_turn);
  if (const auto given_up = give_up_capabilities(); !given_up) {
    return unusable(given_up.error());
  }
  try {
    const auto model = load_model(options);
    if (!model) {
      return unusable(model.error());
    }
    auto store = begin_store(options, *model);
    if (!store) {
      return unusable(store.error());
    }
    const auto log = start_log(options);
    if (!log) {
      return unusable(log.error());
    }
    return serve_and_log(options, *model, *store, **log);
  } catch (const std::exception& error) {
    std::cerr << "interlock-app: uncaught exception: " << error.what() << std::endl;
    return exit_failed;
  }
}

}  // namespace
}  // namespace interlock

int main(int argc, char** argv) {
  std::signal(SIGPIPE, SIG_IGN);
  std::set_terminate(interlock::record_and_abort);
  interlock::Options options;
  CLI::App cli("Shows the robot and proposes motion to the kernel.", "interlock-app");
  interlock::describe(cli, options);
  try {
    cli.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return cli.exit(error) == 0 ? 0 : interlock::exit_unusable;
  }
  return interlock::run(options);
}

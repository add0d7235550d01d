#include "cli/supervisor.hpp"

#include <poll.h>
#include <signal.h>
#include <sys/signalfd.h>

#include <algorithm>
#include <cerrno>
#include <ranges>
#include <system_error>
#include <utility>

namespace interlock::cli {
namespace {

using namespace std::chrono_literals;

constexpr std::size_t restarts_allowed = 5;
constexpr auto restart_window = 60s;

/** Far beyond any start on a busy machine: what has not started by then hangs. */
constexpr auto longest_start = 30s;

sigset_t termination_signals() {
  sigset_t signals;
  sigemptyset(&signals);
  sigaddset(&signals, SIGINT);
  sigaddset(&signals, SIGTERM);
  sigaddset(&signals, SIGHUP);
  return signals;
}

constexpr std::string_view first_login = "first login: ";

bool says_ready(std::string_view line) { return line == "ready" || line.starts_with("ready "); }

}  // namespace

SignalEvents::SignalEvents() {
  const sigset_t signals = termination_signals();
  sigprocmask(SIG_BLOCK, &signals, nullptr);
  fd_ = FileDescriptor(signalfd(-1, &signals, SFD_CLOEXEC | SFD_NONBLOCK));
  if (!fd_) {
    throw std::system_error(errno, std::generic_category(), "signalfd");
  }
}

SignalEvents::~SignalEvents() {
  while (take()) {
    // Those that came while the children were stopped are answered by the stop.
  }
  const sigset_t signals = termination_signals();
  sigprocmask(SIG_UNBLOCK, &signals, nullptr);
}

bool SignalEvents::take() const {
  signalfd_siginfo info{};
  return read(fd_.get(), &info, sizeof info) == sizeof info;
}

Supervisor::Supervisor(std::vector<Supervised> programs, const SignalEvents& signals, std::ostream& output)
    : signals_(signals), output_(output) {
  for (Supervised& supervised : programs) {
    tasks_.push_back({std::move(supervised), RestartBudget(restarts_allowed, restart_window)});
  }
}

Result<void> Supervisor::run(const std::function<void()>& when_ready) {
  const Result<void> result = serve(when_ready);
  for (Task& task : std::views::reverse(tasks_)) {
    stop(task);
  }
  return result;
}

Result<void> Supervisor::serve(const std::function<void()>& when_ready) {
  Result<void> going = start_next(when_ready);
  while (going) {
    const Event event = next_event(next_check());
    if (std::holds_alternative<StopAsked>(event)) {
      break;
    }
    if (const Ready* const ready = std::get_if<Ready>(&event)) {
      going = note_ready(ready->task, when_ready);
    } else if (const Ended* const ended = std::get_if<Ended>(&event)) {
      going = judge_end(*ended, when_ready);
    } else {
      check_times();
    }
  }
  return going;
}

Result<void> Supervisor::note_ready(Task& task, const std::function<void()>& when_ready) {
  if (std::exchange(task.ready, true)) {
    return {};
  }
  task.was_ready = true;
  task.kill_at.reset();
  if (task.supervised.program.watchdog.count() > 0) {
    task.watchdog.emplace(task.supervised.program.watchdog, Clock::now());
  }
  return start_next(when_ready);
}

Result<void> Supervisor::start_next(const std::function<void()>& when_ready) {
  const auto next = std::ranges::find_if(tasks_, [](const Task& task) { return !task.ready && !task.left; });
  if (next == tasks_.end()) {
    when_ready();
    return {};
  }
  // One that was restarted while another was starting is on its way already.
  return next->child ? Result<void>() : start(*next);
}

Result<void> Supervisor::start(Task& task) {
  Result<ChildProcess> child = ChildProcess::start(task.supervised.program);
  if (!child) {
    return tl::unexpected(child.error());
  }
  task.child.emplace(std::move(*child));
  task.kill_at = Clock::now() + longest_start;
  return {};
}

Result<void> Supervisor::judge_end(const Ended& ended, const std::function<void()>& when_ready) {
  Task& task = ended.task;
  task.ready = false;
  task.watchdog.reset();
  task.kill_at.reset();
  const std::string& name = task.supervised.program.name;
  const AtEnd at_end = task.supervised.at_end;
  const std::string end = describe_end(ended.wait_status);
  if (!task.was_ready) {
    return failed(ExitCode::process_ended, name + " did not start: " + end + "; its output above says why");
  }
  if (at_end == AtEnd::stop_all) {
    return failed(ExitCode::process_ended,
                  name + " ended: " + end + "; nothing can move without it, so all was stopped");
  }
  if (!task.budget.spend(Clock::now())) {
    const std::string often = name + " ended: " + end + "; it was restarted " +
                              std::to_string(restarts_allowed) + " times within a minute already, so ";
    if (at_end == AtEnd::restart) {
      return failed(ExitCode::app_kept_ending, often + "all was stopped");
    }
    task.left = true;
    output_ << "interlock: " << often << "it is not started again; all else goes on without it" << std::endl;
    return start_next(when_ready);
  }
  output_ << "interlock: " << name << " ended: " << end << "; restarting it (" << task.budget.spent()
          << " of " << restarts_allowed << " within a minute)" << std::endl;
  return start(task);
}

Supervisor::Deadline Supervisor::next_check() const {
  Deadline next;
  const auto not_after = [&](Clock::time_point time) { next = std::min(next.value_or(time), time); };
  for (const Task& task : tasks_) {
    if (task.kill_at) {
      not_after(*task.kill_at);
    }
    if (task.watchdog) {
      not_after(task.watchdog->next_look());
    }
  }
  return next;
}

void Supervisor::check_times() {
  output_.flush();  // A reader may have made room for what was lost.
  const Clock::time_point now = Clock::now();
  for (Task& task : tasks_) {
    const std::string& name = task.supervised.program.name;
    if (task.kill_at && now >= *task.kill_at) {
      output_ << "interlock: " << name << (task.ready ? " did not end" : " was not ready")
              << " in time; killing it" << std::endl;
      task.kill_at.reset();
      task.child->send(SIGKILL);
    }
    if (task.watchdog && task.watchdog->has_expired(now)) {
      output_ << "interlock: " << name << " gave no sign of life for "
              << std::chrono::duration<double>(task.supervised.program.watchdog).count() << " s; ending it"
              << std::endl;
      task.watchdog.reset();
      task.kill_at = now + task.supervised.longest_end;
      task.child->send(SIGABRT);
    }
  }
}

void Supervisor::stop(Task& task) {
  if (!task.child) {
    return;
  }
  task.child->send(SIGTERM);
  Deadline timeout = Clock::now() + task.supervised.longest_end;
  while (task.child) {
    const Event event = next_event(timeout);
    if (std::holds_alternative<TimedOut>(event) || std::holds_alternative<StopAsked>(event)) {
      task.child->send(SIGKILL);
      timeout.reset();
    }
  }
}

Supervisor::Event Supervisor::next_event(Deadline deadline) {
  while (events_.empty()) {
    collect_events(deadline);
  }
  const Event event = events_.front();
  events_.pop_front();
  return event;
}

void Supervisor::collect_events(Deadline deadline) {
  std::vector<pollfd> polled{{signals_.fd(), POLLIN, 0}};
  for (const Task& task : tasks_) {
    polled.push_back({task.child ? task.child->output_fd() : -1, POLLIN, 0});
    polled.push_back({task.child ? task.child->end_fd() : -1, POLLIN, 0});
    polled.push_back({task.child ? task.child->life_fd() : -1, POLLIN, 0});
  }
  int wait_ms = -1;
  if (deadline) {
    const auto left = std::chrono::ceil<std::chrono::milliseconds>(*deadline - Clock::now());
    wait_ms = static_cast<int>(std::max(left, 0ms).count());
  }
  poll(polled.data(), polled.size(), wait_ms);
  if (polled.front().revents != 0 && signals_.take()) {
    events_.push_back(StopAsked{});
  }
  // In the order of their start: when one takes another down, the first of them is named as the cause.
  for (Task& task : tasks_) {
    if (task.child) {
      forward_output(task, false);
      if (task.child->gave_sign_of_life() && task.watchdog) {
        task.watchdog->feed();
      }
    }
    const std::optional<int> wait_status = task.child ? task.child->reap() : std::nullopt;
    if (wait_status) {
      forward_output(task, true);
      task.child.reset();
      events_.push_back(Ended{task, *wait_status});
    }
  }
  // Not only when nothing came: one that never stops writing must not put off what is due.
  if (events_.empty() && deadline && Clock::now() >= *deadline) {
    events_.push_back(TimedOut{});
  }
}

void Supervisor::forward_output(Task& task, bool rest) {
  for (const std::string& line : task.child->read_lines(rest)) {
    if (line.starts_with(first_login)) {
      output_ << line << '\n';
      first_login_ = line.substr(first_login.size());
      continue;
    }
    output_ << '[' << task.supervised.program.name << "] " << line << '\n';
    if (says_ready(line)) {
      events_.push_back(Ready{task});
    }
  }
  output_.flush();
}

}  // namespace interlock::cli

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
  fd_ = UniqueFd(signalfd(-1, &signals, SFD_CLOEXEC | SFD_NONBLOCK));
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
    : signals_(signals), budget_(restarts_allowed, restart_window), output_(output) {
  for (Supervised& supervised : programs) {
    tasks_.emplace_back().supervised = std::move(supervised);
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
    const Event event = next_event(ready_until_);
    if (std::holds_alternative<StopAsked>(event)) {
      break;
    }
    if (const Ready* const ready = std::get_if<Ready>(&event)) {
      going = note_ready(ready->task, when_ready);
    } else if (const Ended* const ended = std::get_if<Ended>(&event)) {
      going = judge_end(*ended);
    } else {
      give_up_waiting();
    }
  }
  return going;
}

Result<void> Supervisor::note_ready(Task& task, const std::function<void()>& when_ready) {
  if (std::exchange(task.ready, true)) {
    return {};
  }
  task.was_ready = true;
  return start_next(when_ready);
}

Result<void> Supervisor::start_next(const std::function<void()>& when_ready) {
  ready_until_.reset();
  const auto next = std::ranges::find(tasks_, false, &Task::ready);
  if (next == tasks_.end()) {
    when_ready();
    return {};
  }
  Result<ChildProcess> child = ChildProcess::start(next->supervised.program);
  if (!child) {
    return tl::unexpected(child.error());
  }
  next->child.emplace(std::move(*child));
  ready_until_ = Clock::now() + longest_start;
  return {};
}

Result<void> Supervisor::judge_end(const Ended& ended) {
  ended.task.ready = false;
  const std::string& name = ended.task.supervised.program.name;
  const std::string end = describe_end(ended.wait_status);
  if (!ended.task.was_ready) {
    return failed(ExitCode::process_ended, name + " did not start: " + end + "; its output above says why");
  }
  if (!ended.task.supervised.restarts) {
    return failed(ExitCode::process_ended,
                  name + " ended: " + end + "; nothing can move without it, so all was stopped");
  }
  if (!budget_.spend(Clock::now())) {
    return failed(ExitCode::app_kept_ending, name + " ended: " + end + "; it was restarted " +
                                                 std::to_string(restarts_allowed) +
                                                 " times within a minute already, so all was stopped");
  }
  output_ << "interlock: " << name << " ended: " << end << "; restarting it (" << budget_.spent() << " of "
          << restarts_allowed << " within a minute)" << std::endl;
  return start_next([] {});
}

void Supervisor::give_up_waiting() {
  ready_until_.reset();
  for (const Task& task : tasks_) {
    if (task.child && !task.ready) {
      output_ << "interlock: " << task.supervised.program.name << " was not ready in time; killing it"
              << std::endl;
      task.child->send(SIGKILL);
    }
  }
}

void Supervisor::stop(Task& task) {
  if (!task.child) {
    return;
  }
  task.child->send(SIGTERM);
  Deadline patience = Clock::now() + task.supervised.longest_end;
  while (task.child) {
    const Event event = next_event(patience);
    if (std::holds_alternative<TimedOut>(event) || std::holds_alternative<StopAsked>(event)) {
      task.child->send(SIGKILL);
      patience.reset();
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
  }
  int wait_ms = -1;
  if (deadline) {
    const auto left = std::chrono::ceil<std::chrono::milliseconds>(*deadline - Clock::now());
    wait_ms = static_cast<int>(std::max(left, 0ms).count());
  }
  if (poll(polled.data(), polled.size(), wait_ms) == 0) {
    events_.push_back(TimedOut{});
    return;
  }
  if (polled.front().revents != 0 && signals_.take()) {
    events_.push_back(StopAsked{});
  }
  // In the order of their start: when one takes another down, the first of them is named as the cause.
  for (Task& task : tasks_) {
    if (task.child) {
      forward_output(task, false);
    }
    const std::optional<int> wait_status = task.child ? task.child->reap() : std::nullopt;
    if (wait_status) {
      forward_output(task, true);
      task.child.reset();
      events_.push_back(Ended{task, *wait_status});
    }
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

#include "log/writing_thread.hpp"

#include <signal.h>

#include <condition_variable>
#include <deque>
#include <mutex>
#include <utility>

namespace interlock {

/** Shared with the thread, which may outlive its owner. */
struct WritingThread::State {
  explicit State(std::function<void(std::uint64_t)> tell) : tell_lost(std::move(tell)) {}

  const std::function<void(std::uint64_t)> tell_lost;
  std::mutex mutex;
  std::condition_variable changed;
  std::deque<Job> jobs;
  bool busy = false;     /**< with a job that is no longer in the queue */
  bool refusing = false; /**< was full and is not half empty yet */
  bool ending = false;
  std::uint64_t lost = 0;
  std::uint64_t told = 0; /**< of those */
};

WritingThread::WritingThread(std::function<void(std::uint64_t)> tell_lost)
    : state_(std::make_shared<State>(std::move(tell_lost))) {
  // Signals are for the threads that wait for them.
  sigset_t all;
  sigset_t before;
  sigfillset(&all);
  pthread_sigmask(SIG_SETMASK, &all, &before);
  thread_ = std::thread([state = state_] { work(*state); });
  pthread_sigmask(SIG_SETMASK, &before, nullptr);
}

WritingThread::~WritingThread() {
  const bool idle = wait_until_done(Clock::now());
  {
    const std::lock_guard lock(state_->mutex);
    state_->ending = true;
  }
  state_->changed.notify_all();
  idle ? thread_.join() : thread_.detach();
}

void WritingThread::add(Job job) {
  {
    const std::lock_guard lock(state_->mutex);
    state_->refusing = state_->refusing || state_->jobs.size() >= capacity;
    if (state_->refusing) {
      ++state_->lost;
      return;
    }
    state_->jobs.push_back(std::move(job));
  }
  state_->changed.notify_all();
}

bool WritingThread::wait_until_done(Clock::time_point then) const {
  std::unique_lock lock(state_->mutex);
  return state_->changed.wait_until(lock, then, [&] { return state_->jobs.empty() && !state_->busy; });
}

std::uint64_t WritingThread::lost() const {
  const std::lock_guard lock(state_->mutex);
  return state_->lost;
}

void WritingThread::work(State& state) {
  std::unique_lock lock(state.mutex);
  while (true) {
    state.changed.wait(lock, [&] { return state.ending || !state.jobs.empty(); });
    if (state.ending) {
      return;
    }
    Job job = std::move(state.jobs.front());
    state.jobs.pop_front();
    state.busy = true;
    lock.unlock();
    bool done = true;
    try {
      job();
    } catch (...) {
      done = false;
    }
    job = nullptr;
    lock.lock();
    state.busy = false;
    state.lost += done ? 0 : 1;
    state.refusing = state.refusing && state.jobs.size() > capacity / 2;
    // Not after a failure: it would fail as well, and be one more to tell of.
    if (done && !state.refusing && state.lost > state.told) {
      state.jobs.push_back(
          [&state, gap = state.lost - std::exchange(state.told, state.lost)] { state.tell_lost(gap); });
    }
    state.changed.notify_all();
  }
}

}  // namespace interlock

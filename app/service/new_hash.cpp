#include "service/new_hash.hpp"

#include "service/store_executor.hpp"

namespace interlock {

boost::asio::awaitable<tl::expected<PasswordHash, Problem>> new_hash(WorkPool& pool, std::string user,
                                                                     Password password, std::string field) {
  auto work = [user = std::move(user), password = std::move(password)] {
    return PasswordHash::of_new(password, user);
  };
  const auto hashed = co_await pool.run(std::move(work));
  if (!hashed) {
    co_return tl::make_unexpected(hashed.error());
  }
  if (!*hashed) {
    Problem problem = problem_of(hashed->error());
    problem.field = problem.field.empty() ? "" : field;
    co_return tl::make_unexpected(std::move(problem));
  }
  co_return **hashed;
}

}  // namespace interlock

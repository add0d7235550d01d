#include "trajectory/trajectory_csv.hpp"

#include <algorithm>
#include <charconv>
#include <utility>

#include "trajectory/trajectory_header.hpp"

namespace interlock {
namespace {

using Code = TrajectoryError::Code;

constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";
constexpr std::size_t longest_quote = 32;

/** Takes the part up to `separator` off the front of `text`. */
std::string_view take(std::string_view& text, char separator) {
  const std::string_view part = text.substr(0, text.find(separator));
  text.remove_prefix(std::min(part.size() + 1, text.size()));
  return part;
}

std::string_view take_line(std::string_view& text) {
  std::string_view line = take(text, '\n');
  if (line.ends_with('\r')) {
    line.remove_suffix(1);
  }
  return line;
}

std::string_view trimmed(std::string_view field) {
  const std::size_t begin = field.find_first_not_of(" \t");
  return begin == std::string_view::npos ? std::string_view()
                                         : field.substr(begin, field.find_last_not_of(" \t") + 1 - begin);
}

/** A field in a form that fits any error: short, and of printable ASCII alone. */
std::string quoted(std::string_view field) {
  std::string quote(field.substr(0, longest_quote));
  std::ranges::replace_if(quote, [](char letter) { return letter < ' ' || letter > '~'; }, '?');
  return field.size() > longest_quote ? quote + "..." : quote;
}

std::size_t count_fields(std::string_view line) {
  return static_cast<std::size_t>(std::ranges::count(line, ',')) + 1;
}

/** The columns' names, unless there are more than axes with position and velocity could need. */
TrajectoryResult<std::vector<std::string>> header_of(std::string_view line, const Robot& robot) {
  const std::size_t most = 1 + 2 * robot.axes.size();
  const std::size_t count = count_fields(line);
  if (count > most) {
    return tl::unexpected(TrajectoryError{Code::wrong_columns, 1, "", std::to_string(count) + " columns",
                                          std::to_string(most) + " at most"});
  }
  std::vector<std::string> columns;
  while (columns.size() < count) {
    columns.push_back(quoted(trimmed(take(line, ','))));
  }
  return columns;
}

TrajectoryResult<double> number_of(std::string_view field) {
  double number = 0.0;
  const auto [end, error] = std::from_chars(field.data(), field.data() + field.size(), number);
  if (error == std::errc::result_out_of_range) {
    return tl::unexpected(
        TrajectoryError{Code::out_of_range, 0, "", quoted(field) + " does not fit a number", "a number"});
  }
  if (error != std::errc{} || end != field.data() + field.size()) {
    return tl::unexpected(
        TrajectoryError{Code::not_a_number, 0, "", '"' + quoted(field) + "\" is not a number", "a number"});
  }
  return number;
}

/** Reads the numbers of a line into a row that has a place for each. */
TrajectoryResult<void> read_row(std::string_view line, const TrajectoryBuilder& builder,
                                std::vector<double>& row) {
  if (const std::size_t count = count_fields(line); count != row.size()) {
    return tl::unexpected(wrong_columns(builder.line(), count, builder.columns()));
  }
  for (std::size_t place = 0; place < row.size(); ++place) {
    const TrajectoryResult<double> number = number_of(trimmed(take(line, ',')));
    if (!number) {
      TrajectoryError error = number.error();
      error.line = builder.line();
      error.column = builder.columns()[place];
      return tl::unexpected(std::move(error));
    }
    row[place] = *number;
  }
  return {};
}

TrajectoryResult<TimedTrajectory> read_rows(std::string_view rows, TrajectoryBuilder builder) {
  std::vector<double> row(builder.columns().size());
  while (!rows.empty()) {
    const TrajectoryResult<void> added =
        read_row(take_line(rows), builder, row).and_then([&] { return builder.add(row); });
    if (!added) {
      return tl::unexpected(added.error());
    }
  }
  return std::move(builder).finish();
}

TrajectoryResult<void> check_size(std::string_view text) {
  if (text.empty()) {
    return tl::unexpected(
        TrajectoryError{Code::empty, 1, std::string(time_column), "no text", "a header and rows"});
  }
  const auto lines =
      static_cast<std::size_t>(std::ranges::count(text, '\n')) + (text.ends_with('\n') ? 0 : 1);
  constexpr std::size_t most_lines = most_trajectory_rows + 1;
  if (text.size() > most_trajectory_bytes || lines > most_lines) {
    return tl::unexpected(TrajectoryError{Code::too_large, lines > most_lines ? most_lines + 1 : 0, "",
                                          "too long a text",
                                          std::to_string(most_trajectory_rows) + " rows and " +
                                              std::to_string(most_trajectory_bytes) + " bytes at most"});
  }
  return {};
}

}  // namespace

TrajectoryResult<TimedTrajectory> read_trajectory(std::string_view text, const Robot& robot, Timing timing) {
  if (text.starts_with(byte_order_mark)) {
    text.remove_prefix(byte_order_mark.size());
  }
  return check_size(text)
      .and_then([&] { return header_of(take_line(text), robot); })
      .and_then([&](std::vector<std::string>&& columns) {
        return TrajectoryBuilder::create(std::move(columns), robot, timing);
      })
      .and_then([&](TrajectoryBuilder&& builder) { return read_rows(text, std::move(builder)); });
}

}  // namespace interlock

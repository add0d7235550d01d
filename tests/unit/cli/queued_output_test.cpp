#include "cli/queued_output.hpp"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <poll.h>
#include <unistd.h>

#include <array>
#include <csignal>
#include <optional>
#include <string>

#include "system/file_descriptor.hpp"

namespace interlock::cli {
namespace {

using testing::HasSubstr;

class QueuedOutputTest : public testing::Test {
 protected:
  QueuedOutputTest() {
    std::array<int, 2> ends{};
    EXPECT_EQ(pipe2(ends.data(), O_CLOEXEC), 0);
    reader_ = FileDescriptor(ends[0]);
    writer_ = FileDescriptor(ends[1]);
    output_.emplace(writer_.get());
  }

  /** The next line that its reader gets, waiting for it. */
  std::string read_line() {
    std::string line;
    char letter = 0;
    while (read_letter(letter) && letter != '\n') {
      line += letter;
    }
    return line;
  }

  bool read_letter(char& letter) {
    pollfd come{reader_.get(), POLLIN, 0};
    while (output_ && poll(&come, 1, 1) == 0) {
      output_->stream().flush();  // As the supervisor does, so that a loss is told.
    }
    return read(reader_.get(), &letter, 1) == 1;
  }

  FileDescriptor reader_;
  FileDescriptor writer_;
  std::optional<QueuedOutput> output_;
};

TEST_F(QueuedOutputTest, writes_whole_lines_in_their_order) {
  output_->stream() << "one " << 1 << "\ntwo" << std::flush << '\n' << std::endl;
  EXPECT_EQ(read_line(), "one 1");
  EXPECT_EQ(read_line(), "two");
  EXPECT_EQ(read_line(), "");
}

TEST_F(QueuedOutputTest, has_written_what_it_was_given_when_it_ends) {
  output_->stream() << "last words\n";
  output_.reset();
  EXPECT_EQ(read_line(), "last words");
}

TEST_F(QueuedOutputTest, without_a_reader_nobody_waits_and_each_lost_line_is_counted_where_it_is_missing) {
  const std::string filler(1000, 'x');
  const std::size_t lines = 10'000;
  for (std::size_t line = 0; line < lines; ++line) {
    output_->stream() << line << ' ' << filler << '\n';
  }
  for (std::size_t line = 0;; ++line) {
    const std::string found = read_line();
    if (!found.starts_with("interlock: ")) {
      ASSERT_EQ(std::stoul(found), line);
      continue;
    }
    EXPECT_EQ(found,
              "interlock: " + std::to_string(lines - line) + " lines were lost: nobody read them in time");
    break;
  }
  output_->stream() << "later\n";
  EXPECT_EQ(read_line(), "later");
}

TEST_F(QueuedOutputTest, waits_for_no_reader_at_its_end) {
  for (std::size_t line = 0; line < 10'000; ++line) {
    output_->stream() << std::string(1000, 'x') << '\n';
  }
  output_.reset();
}

TEST_F(QueuedOutputTest, a_reader_that_is_gone_holds_up_nobody) {
  const auto before = std::signal(SIGPIPE, SIG_IGN);
  reader_ = FileDescriptor();
  output_->stream() << "into the void\n";
  output_.reset();
  std::signal(SIGPIPE, before);
}

}  // namespace
}  // namespace interlock::cli

#include <gtest/gtest.h>

#include "service/store_executor.hpp"

namespace interlock::web {
namespace {

AuditEntry note(int number) {
  AuditEntry entry;
  entry.kind = AuditKind::verdict;
  entry.detail = {{"number", number}};
  return entry;
}

int number_of(const AuditEntry& entry) { return entry.detail["number"].get<int>(); }

TEST(AuditNotes, WhatIsGivenBackComesBeforeWhatCameMeanwhile) {
  AuditNotes notes;
  notes.add(note(1));
  notes.add(note(2));
  AuditNotes::Batch batch = notes.take();
  notes.add(note(3));
  notes.give_back(std::move(batch));
  int expected = 0;
  for (const AuditEntry& entry : notes.take()) {
    EXPECT_EQ(number_of(entry), ++expected);
  }
  EXPECT_EQ(expected, 3);
}

TEST(AuditNotes, NoMoreWaitThanFitHoweverOftenTheStoreFails) {
  AuditNotes notes;
  std::size_t lost = 0;
  for (std::size_t i = 0; i < AuditNotes::capacity + 10; ++i) {
    lost += notes.add(note(static_cast<int>(i))) ? 0 : 1;
  }
  for (int failure = 0; failure < 20; ++failure) {
    AuditNotes::Batch batch = notes.take();
    for (int i = 0; i < 7; ++i) {
      lost += notes.add(note(0)) ? 0 : 1;
    }
    notes.give_back(std::move(batch));
  }
  const AuditNotes::Batch batch = notes.take();
  EXPECT_EQ(lost, 10u + 20u * 7u);
  EXPECT_EQ(batch.size(), AuditNotes::capacity + 1);
  EXPECT_EQ(batch.back().kind, AuditKind::records_lost);
  EXPECT_EQ(batch.back().detail["count"], lost);
  EXPECT_EQ(batch.back().actor, audit_actor::app);
}

TEST(AuditNotes, TheLossStandsWhereTheRecordsAreMissing) {
  AuditNotes notes;
  for (std::size_t i = 0; i <= AuditNotes::capacity; ++i) {
    notes.add(note(1));
  }
  const AuditNotes::Batch written = notes.take();
  EXPECT_EQ(written.back().kind, AuditKind::records_lost);
  notes.confirm();
  EXPECT_TRUE(notes.add(note(2)));
  EXPECT_EQ(number_of(notes.take().front()), 2);
}

}  // namespace
}  // namespace interlock::web

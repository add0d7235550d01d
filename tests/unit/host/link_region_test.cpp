#include "link_region.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <string>

#include "fixtures.hpp"

namespace {

using interlock::host_test::Descriptor;

class LinkRegion : public ::testing::Test {
 protected:
  void SetUp() override {
    ilk_error_t error{};
    ASSERT_TRUE(ilk_link_regions_create(&regions, 7, &error)) << error.text;
    held = Descriptor(dup(regions.app_descriptor));
    app = static_cast<ilk_link_app_region_t*>(map_writable(held.get(), kAppBytes));
    ASSERT_NE(static_cast<void*>(app), MAP_FAILED);
  }
  void TearDown() override {
    munmap(app, kAppBytes);
    ilk_link_regions_destroy(&regions);
  }

  static void* map_writable(int descriptor, size_t bytes) {
    return mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_SHARED, descriptor, 0);
  }

  static std::string proc_path(int descriptor) { return "/proc/self/fd/" + std::to_string(descriptor); }

  ilk_link_regions_t regions{};
  Descriptor held{-1};                   ///< of the app's region, as the app has it
  ilk_link_app_region_t* app = nullptr;  ///< the app's own mapping
  static constexpr size_t kKernelBytes = sizeof(ilk_link_kernel_region_t);
  static constexpr size_t kAppBytes = sizeof(ilk_link_app_region_t);
};

TEST_F(LinkRegion, KernelRegionCannotBeMappedWritable) {
  EXPECT_EQ(map_writable(regions.kernel_descriptor, kKernelBytes), MAP_FAILED);
  EXPECT_EQ(errno, EPERM);
}

TEST_F(LinkRegion, ReadOnlyMappingOfTheKernelRegionCannotBeUpgraded) {
  void* address = mmap(nullptr, kKernelBytes, PROT_READ, MAP_SHARED, regions.kernel_descriptor, 0);
  ASSERT_NE(address, MAP_FAILED);
  EXPECT_NE(mprotect(address, kKernelBytes, PROT_READ | PROT_WRITE), 0);
  EXPECT_EQ(errno, EACCES);
  EXPECT_NE(madvise(address, kKernelBytes, MADV_REMOVE), 0);
  EXPECT_EQ(munmap(address, kKernelBytes), 0);
}

TEST_F(LinkRegion, ReopeningTheKernelRegionForWritingDoesNotHelp) {
  const Descriptor reopened(open(proc_path(regions.kernel_descriptor).c_str(), O_RDWR | O_CLOEXEC));
  ASSERT_GE(reopened.get(), 0);
  EXPECT_EQ(map_writable(reopened.get(), kKernelBytes), MAP_FAILED);
  const uint32_t word = 1;
  EXPECT_EQ(pwrite(reopened.get(), &word, sizeof word, 0), -1);
  EXPECT_EQ(fallocate(reopened.get(), FALLOC_FL_PUNCH_HOLE | FALLOC_FL_KEEP_SIZE, 0, 4096), -1);
  EXPECT_EQ(regions.kernel->magic, ILK_LINK_MAGIC);
}

TEST_F(LinkRegion, NeitherRegionCanBeResizedAtAnyTimeOrUnsealed) {
  for (const int descriptor : {regions.kernel_descriptor, held.get()}) {
    EXPECT_EQ(ftruncate(descriptor, 0), -1);
    EXPECT_EQ(ftruncate(descriptor, 1 << 24), -1);
  }
  const Descriptor kernel(dup(regions.kernel_descriptor));
  ASSERT_TRUE(ilk_link_regions_settle(&regions));
  for (const int descriptor : {kernel.get(), held.get()}) {
    EXPECT_EQ(ftruncate(descriptor, 0), -1);
    EXPECT_EQ(fcntl(descriptor, F_ADD_SEALS, F_SEAL_WRITE), -1);
    EXPECT_TRUE(fcntl(descriptor, F_GET_SEALS) & F_SEAL_SEAL);
  }
}

TEST_F(LinkRegion, NoPageCanBeTakenOutOfASettledAppRegion) {
  app->seen_tick = 7;
  ASSERT_TRUE(ilk_link_regions_settle(&regions));
  EXPECT_EQ(fallocate(held.get(), FALLOC_FL_PUNCH_HOLE | FALLOC_FL_KEEP_SIZE, 0, 4096), -1);
  EXPECT_NE(madvise(app, kAppBytes, MADV_REMOVE), 0);
  EXPECT_EQ(map_writable(held.get(), kAppBytes), MAP_FAILED);
  const uint32_t word = 1;
  EXPECT_EQ(pwrite(held.get(), &word, sizeof word, 0), -1);
  EXPECT_EQ(regions.app->seen_tick, 7u);
}

TEST_F(LinkRegion, HolesThatWerePunchedBeforeAreFilledWhenTheRegionIsSettled) {
  ASSERT_EQ(fallocate(held.get(), FALLOC_FL_PUNCH_HOLE | FALLOC_FL_KEEP_SIZE, 0, kAppBytes), 0);
  ASSERT_TRUE(ilk_link_regions_settle(&regions));
  std::array<unsigned char, (kAppBytes + 4095) / 4096> present{};
  ASSERT_EQ(mincore(const_cast<ilk_link_app_region_t*>(regions.app), kAppBytes, present.data()), 0);
  EXPECT_TRUE(std::ranges::all_of(present, [](unsigned char page) { return (page & 1) != 0; }));
}

TEST_F(LinkRegion, ARegionThatTheAppSealedItselfIsNotUsed) {
  ASSERT_EQ(fcntl(held.get(), F_ADD_SEALS, F_SEAL_SEAL), 0);
  EXPECT_FALSE(ilk_link_regions_settle(&regions));
  EXPECT_EQ(regions.app, nullptr);
}

TEST_F(LinkRegion, AppWritesItsRegionAndTheKernelReadsIt) {
  ASSERT_TRUE(ilk_link_regions_settle(&regions));
  EXPECT_EQ(app->magic, ILK_LINK_MAGIC);
  app->seen_tick = 1234;
  EXPECT_EQ(regions.app->seen_tick, 1234u);
}

TEST_F(LinkRegion, KernelsViewOfTheAppRegionIsNotWritable) {
  ASSERT_TRUE(ilk_link_regions_settle(&regions));
  EXPECT_DEATH(const_cast<ilk_link_app_region_t*>(regions.app)->seen_tick = 1, "");
}

TEST_F(LinkRegion, NamesItsLayoutAndGeneration) {
  EXPECT_EQ(regions.kernel->magic, ILK_LINK_MAGIC);
  EXPECT_EQ(regions.kernel->version, ILK_LINK_VERSION);
  EXPECT_EQ(regions.kernel->layout_hash, ilk_link_layout_hash());
  EXPECT_EQ(regions.kernel->generation, 7u);
}

}  // namespace

#include "link_region.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/mman.h>
#include <unistd.h>

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
  }
  void TearDown() override { ilk_link_regions_destroy(&regions); }

  static void* map_writable(int descriptor, size_t bytes) {
    return mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_SHARED, descriptor, 0);
  }

  static std::string proc_path(int descriptor) { return "/proc/self/fd/" + std::to_string(descriptor); }

  ilk_link_regions_t regions{};
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

TEST_F(LinkRegion, NeitherRegionCanBeResizedOrUnsealed) {
  for (const int descriptor : {regions.kernel_descriptor, regions.app_descriptor}) {
    EXPECT_EQ(ftruncate(descriptor, 0), -1);
    EXPECT_EQ(ftruncate(descriptor, 1 << 24), -1);
    EXPECT_EQ(fcntl(descriptor, F_ADD_SEALS, F_SEAL_WRITE), -1);
    EXPECT_TRUE(fcntl(descriptor, F_GET_SEALS) & F_SEAL_SEAL);
  }
}

TEST_F(LinkRegion, AppWritesItsRegionAndTheKernelReadsIt) {
  auto* app = static_cast<ilk_link_app_region_t*>(map_writable(regions.app_descriptor, kAppBytes));
  ASSERT_NE(app, MAP_FAILED);
  EXPECT_EQ(app->magic, ILK_LINK_MAGIC);
  app->seen_tick = 1234;
  EXPECT_EQ(regions.app->seen_tick, 1234u);
  EXPECT_EQ(munmap(app, kAppBytes), 0);
}

TEST_F(LinkRegion, KernelsViewOfTheAppRegionIsNotWritable) {
  EXPECT_DEATH(const_cast<ilk_link_app_region_t*>(regions.app)->seen_tick = 1, "");
}

TEST_F(LinkRegion, NamesItsLayoutAndGeneration) {
  EXPECT_EQ(regions.kernel->magic, ILK_LINK_MAGIC);
  EXPECT_EQ(regions.kernel->version, ILK_LINK_VERSION);
  EXPECT_EQ(regions.kernel->layout_hash, ilk_link_layout_hash());
  EXPECT_EQ(regions.kernel->generation, 7u);
}

}  // namespace

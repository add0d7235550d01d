#include "link_region.h"

#include <errno.h>
#include <fcntl.h>
#include <string.h>
#include <sys/mman.h>
#include <unistd.h>

#define FIXED_SIZE (F_SEAL_SHRINK | F_SEAL_GROW)

static int create_region(const char *name, size_t bytes) {
  const int descriptor = memfd_create(name, MFD_CLOEXEC | MFD_ALLOW_SEALING);
  if (descriptor >= 0 && ftruncate(descriptor, (off_t)bytes) != 0) {
    (void)close(descriptor);
    return -1;
  }
  return descriptor;
}

static void *map_region(int descriptor, size_t bytes, int protection) {
  void *address = mmap(NULL, bytes, protection, MAP_SHARED | MAP_POPULATE, descriptor, 0);
  if (address == MAP_FAILED) {
    address = NULL;
  }
  return address;
}

static bool create_kernel_region(ilk_link_regions_t *regions, uint32_t generation) {
  const size_t bytes = sizeof *regions->kernel;
  regions->kernel_descriptor = create_region("interlock-kernel-region", bytes);
  if (regions->kernel_descriptor < 0) {
    return false;
  }
  regions->kernel = map_region(regions->kernel_descriptor, bytes, PROT_READ | PROT_WRITE);
  if (regions->kernel == NULL) {
    return false;
  }
  regions->kernel->magic = ILK_LINK_MAGIC;
  regions->kernel->version = ILK_LINK_VERSION;
  regions->kernel->layout_hash = ilk_link_layout_hash();
  regions->kernel->generation = generation;
  return fcntl(regions->kernel_descriptor, F_ADD_SEALS, FIXED_SIZE | F_SEAL_FUTURE_WRITE | F_SEAL_SEAL) == 0;
}

static bool create_app_region(ilk_link_regions_t *regions) {
  const uint32_t magic = ILK_LINK_MAGIC;
  regions->app_descriptor = create_region("interlock-app-region", sizeof *regions->app);
  return regions->app_descriptor >= 0 &&
         pwrite(regions->app_descriptor, &magic, sizeof magic, 0) == (ssize_t)sizeof magic &&
         fcntl(regions->app_descriptor, F_ADD_SEALS, FIXED_SIZE) == 0;
}

bool ilk_link_regions_create(ilk_link_regions_t *regions, uint32_t generation, ilk_error_t *error) {
  *regions = (ilk_link_regions_t){.kernel_descriptor = -1, .app_descriptor = -1};
  if (create_kernel_region(regions, generation) && create_app_region(regions)) {
    return true;
  }
  const int reason = errno;
  ilk_link_regions_destroy(regions);
  return ilk_fail(error, "cannot create the link's memory regions: %s", strerror(reason));
}

static void close_descriptor(int *descriptor) {
  if (*descriptor >= 0) {
    (void)close(*descriptor);
    *descriptor = -1;
  }
}

void ilk_link_regions_close(ilk_link_regions_t *regions) {
  close_descriptor(&regions->kernel_descriptor);
  close_descriptor(&regions->app_descriptor);
}

bool ilk_link_regions_settle(ilk_link_regions_t *regions) {
  if (fcntl(regions->app_descriptor, F_ADD_SEALS, F_SEAL_FUTURE_WRITE | F_SEAL_SEAL) == 0) {
    regions->app = map_region(regions->app_descriptor, sizeof *regions->app, PROT_READ);
  }
  ilk_link_regions_close(regions);
  return regions->app != NULL;
}

/** `munmap` wants a pointer to writable memory even for a mapping that can only be read. */
static void unmap_region(const void *address, size_t bytes) {
  void *mapped = NULL;
  (void)memcpy(&mapped, &address, sizeof mapped);
  if (mapped != NULL) {
    (void)munmap(mapped, bytes);
  }
}

void ilk_link_regions_destroy(ilk_link_regions_t *regions) {
  ilk_link_regions_close(regions);
  unmap_region(regions->kernel, sizeof *regions->kernel);
  unmap_region(regions->app, sizeof *regions->app);
  regions->kernel = NULL;
  regions->app = NULL;
}

#include "service_thread.h"

#include <signal.h>
#include <stddef.h>
#include <string.h>
#include <sys/eventfd.h>
#include <unistd.h>

/** Small, because a locked process keeps every stack in memory. */
#define STACK_BYTES ((size_t)256u * 1024u)

static int start(pthread_t *thread, void *(*body)(void *), void *argument) {
  pthread_attr_t attributes;
  const int made = pthread_attr_init(&attributes);
  if (made != 0) {
    return made;
  }
  int result = pthread_attr_setstacksize(&attributes, STACK_BYTES);
  if (result == 0) {
    result = pthread_create(thread, &attributes, body, argument);
  }
  (void)pthread_attr_destroy(&attributes);
  return result;
}

bool ilk_service_thread_start(pthread_t *thread, void *(*body)(void *), void *argument, ilk_error_t *error) {
  sigset_t all;
  sigset_t before;
  (void)sigfillset(&all);
  (void)pthread_sigmask(SIG_SETMASK, &all, &before);
  const int result = start(thread, body, argument);
  (void)pthread_sigmask(SIG_SETMASK, &before, NULL);
  return result == 0 || ilk_fail(error, "cannot start a service thread: %s", strerror(result));
}

void ilk_service_thread_stop(pthread_t thread, int stop_event) {
  (void)eventfd_write(stop_event, 1);
  (void)pthread_join(thread, NULL);
  (void)close(stop_event);
}

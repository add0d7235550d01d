/**
 * @file
 * Threads beside the loop: ordinary priority, small stack, no signals.
 */
#ifndef INTERLOCK_HOST_SERVICE_THREAD_H
#define INTERLOCK_HOST_SERVICE_THREAD_H

#include <pthread.h>

#include "error.h"

/** Starts a thread before real-time rights are taken, so that it inherits none. */
bool ilk_service_thread_start(pthread_t *thread, void *(*body)(void *), void *argument, ilk_error_t *error);

/** Raises the event descriptor that the thread watches, joins it and closes the descriptor. */
void ilk_service_thread_stop(pthread_t thread, int stop_event);

#endif

/**
 * @file
 * Runs the kernel in the random world, with its black box beside it, and writes all of the run into a
 * recording.
 */
#include <stdio.h>

#include "black_box.h"
#include "interlock/recording_file.h"
#include "platform.h"
#include "world.h"

#ifndef RECORDED_TICKS
#error "RECORDED_TICKS is the number of ticks"
#endif
#define RECORDED_SEED 0x1badb002u
#define RING_SECONDS 1u

static ilk_config_t config;
static ilk_state_t state;
static ilk_inputs_t in;
static ilk_outputs_t out;
static ilk_request_t requests[ILK_REQUESTS_PER_TICK];
static world_t world;
static ilk_black_box_t box;

static void write_header(FILE *file) {
  ilk_recording_header_t header = {.why = ILK_RECORDED_CONTINUOUSLY, .run = box.ring->run};
  ilk_recording_seal_header(&header);
  (void)fwrite(&header, sizeof header, 1u, file);
}

static void write_block(FILE *file, const ilk_block_t *block, uint32_t number) {
  const uint32_t used = block->header.used;
  const uint32_t *payload = block->payload;
  const ilk_block_header_t header = ilk_recording_block_header(number, payload, used);
  const uint32_t trailer = ILK_BLOCK_TRAILER(number);
  (void)fwrite(&header, sizeof header, 1u, file);
  (void)fwrite(payload, sizeof *payload, used, file);
  (void)fwrite(&trailer, sizeof trailer, 1u, file);
}

static void run_tick(void) {
  world_inputs(&world, &config, &state, &out, &in);
  const uint32_t wishes = world_requests(&world, &config, &state, requests);
  ilk_step(&config, &state, &in, requests, wishes, &out);
  ilk_black_box_note(&box, state.system.tick, &state, &in, requests, wishes, &out);
}

uint32_t run_image(void) {
  const ilk_black_box_terms_t terms = {
      .config = &config, .clock = ILK_CLOCK_SIM, .simulated = true, .seconds = RING_SECONDS};
  ilk_error_t error;
  world_config(&config);
  world_begin(&world, RECORDED_SEED);
  (void)ilk_init(&config, &state);
  FILE *file = fopen(RECORDING, "wb");
  if (file == NULL || !ilk_black_box_create(&box, &terms, &error)) {
    say("the recording cannot be made\n");
    return 1u;
  }
  ilk_black_box_begin(&box, &state);
  write_header(file);
  for (uint32_t tick = 0u; tick < (uint32_t)RECORDED_TICKS; tick++) {
    const ilk_block_t *block = box.block;
    const uint32_t number = box.ring->head;
    run_tick();
    if (box.ring->head != number) {
      write_block(file, block, number);
    }
  }
  write_block(file, box.block, box.ring->head);
  ilk_black_box_close(&box);
  return fclose(file) == 0 ? 0u : 1u;
}

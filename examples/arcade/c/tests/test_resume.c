/* What is left of a state after crashes at any place. */
#include "check.h"
#include "resume.h"
#include "tests.h"

#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

typedef struct state {
    uint64_t time_us;
    double position[3];
} state;

static char path[] = "/tmp/arcade-check-XXXXXX";

static void fill(state *state, uint64_t time_us) {
    memset(state, 0, sizeof *state);
    state->time_us = time_us;
    state->position[1] = (double)time_us;
}

/* A new, empty file. */
static void renew(void) {
    int file = open(path, O_RDWR | O_TRUNC);
    CHECK(file >= 0);
    close(file);
}

/* The file after states of the times 1 to `count` were stored. */
static void write_states(uint64_t count) {
    resume file;
    state state;
    renew();
    CHECK(resume_open(&file, path, sizeof state));
    for (uint64_t time_us = 1; time_us <= count; time_us++) {
        fill(&state, time_us);
        resume_store(&file, &state);
    }
    resume_close(&file);
}

/* The time of the state that the file has, or 0. */
static uint64_t read_time(void) {
    resume file;
    state state;
    CHECK(resume_open(&file, path, sizeof state));
    bool found = resume_load(&file, &state);
    resume_close(&file);
    CHECK(!found || state.position[1] == (double)state.time_us);
    return found ? state.time_us : 0;
}

static void flip_byte(long place) {
    FILE *file = fopen(path, "r+");
    fseek(file, place, SEEK_SET);
    int byte = fgetc(file);
    fseek(file, place, SEEK_SET);
    fputc(byte ^ 0x10, file);
    fclose(file);
}

static void an_empty_file_has_no_state(void) {
    renew();
    CHECK(read_time() == 0);
}

static void the_newest_state_is_found(void) {
    for (uint64_t count = 1; count < 5; count++) {
        write_states(count);
        CHECK(read_time() == count);
    }
}

/* Whichever byte a crash or a bad disk has changed, a complete state is found: the newest, or the one before. */
static void each_damaged_byte_is_noticed(void) {
    enum { COPY = 3 * sizeof(uint64_t) + sizeof(state) };
    for (long place = 0; place < 2 * COPY; place++) {
        write_states(4);
        flip_byte(place);
        CHECK(read_time() == (place < COPY ? 3 : 4)); /* even sequence numbers are in the first copy */
    }
}

static void a_state_of_another_size_is_not_read(void) {
    resume file;
    char other[sizeof(state) - 8];
    write_states(2);
    CHECK(resume_open(&file, path, sizeof other));
    CHECK(!resume_load(&file, other));
    resume_close(&file);
}

static void a_file_that_cannot_be_opened_is_done_without(void) {
    resume file;
    state state;
    fill(&state, 1);
    CHECK(!resume_open(&file, "/nonexistent/state", sizeof state));
    CHECK(errno == ENOENT);
    resume_store(&file, &state);
    CHECK(!resume_load(&file, &state));
    resume_close(&file);
}

void test_resume(void) {
    int created = mkstemp(path);
    CHECK(created >= 0);
    close(created);
    an_empty_file_has_no_state();
    the_newest_state_is_found();
    each_damaged_byte_is_noticed();
    a_state_of_another_size_is_not_read();
    a_file_that_cannot_be_opened_is_done_without();
    unlink(path);
}

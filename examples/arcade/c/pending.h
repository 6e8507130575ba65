/*
 * Messages that wait for the beat at which they take effect. A message takes effect at a time of its own rather than
 * when it arrives. As long as it arrives before that, the outcome does not depend on the operating system's schedule,
 * and a recorded flight can be repeated exactly.
 */
#ifndef PENDING_H
#define PENDING_H

#include "readings.h"

/* More would mean that the beat has stopped; then the oldest are of no use. */
enum { PENDING_CAPACITY = 8 };

/* One of these: a queue has messages of one gate. */
typedef union pending_message {
    height_reading height;
    fix_reading fix;
    command command;
} pending_message;

/* Messages of one gate, ordered by the time at which they are due. */
typedef struct pending {
    size_t count;
    uint64_t due_us[PENDING_CAPACITY];
    pending_message messages[PENDING_CAPACITY];
} pending;

/* Keeps a message until `due_us`. Of messages that are due at the same time, the first to arrive comes first. */
void pending_insert(pending *self, uint64_t due_us, pending_message message);

/* Takes the next message that is due at `now_us`. Returns false if there is none. */
bool pending_take_due(pending *self, uint64_t now_us, pending_message *message);

#endif

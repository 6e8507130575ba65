/* Messages that wait for the beat at which they take effect. */
#include "pending.h"

#include <string.h>

static void remove_first(pending *self) {
    self->count--;
    memmove(self->due_us, self->due_us + 1, self->count * sizeof *self->due_us);
    memmove(self->messages, self->messages + 1, self->count * sizeof *self->messages);
}

void pending_insert(pending *self, uint64_t due_us, pending_message message) {
    if (self->count == PENDING_CAPACITY) {
        remove_first(self);
    }
    size_t index = self->count++;
    for (; index > 0 && self->due_us[index - 1] > due_us; index--) {
        self->due_us[index] = self->due_us[index - 1];
        self->messages[index] = self->messages[index - 1];
    }
    self->due_us[index] = due_us;
    self->messages[index] = message;
}

bool pending_take_due(pending *self, uint64_t now_us, pending_message *message) {
    if (self->count == 0 || self->due_us[0] > now_us) {
        return false;
    }
    *message = self->messages[0];
    remove_first(self);
    return true;
}

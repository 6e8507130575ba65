/* The order in which messages take effect. */
#include "check.h"
#include "pending.h"
#include "tests.h"

static void insert(pending *self, uint64_t due_us, uint32_t id) {
    pending_insert(self, due_us, (pending_message){.command = {.id = id}});
}

/* The id of the message that is taken, or 0. */
static uint32_t take(pending *self, uint64_t now_us) {
    pending_message message;
    return pending_take_due(self, now_us, &message) ? message.command.id : 0;
}

static void messages_are_taken_in_the_order_in_which_they_are_due(void) {
    pending self = {0};
    insert(&self, 30, 3);
    insert(&self, 10, 1);
    insert(&self, 30, 4);
    insert(&self, 20, 2);
    CHECK(take(&self, 9) == 0);
    CHECK(take(&self, 20) == 1);
    CHECK(take(&self, 20) == 2);
    CHECK(take(&self, 20) == 0);
    CHECK(take(&self, 99) == 3);
    CHECK(take(&self, 99) == 4);
    CHECK(take(&self, 99) == 0);
}

static void the_oldest_gives_way_when_nothing_is_taken(void) {
    pending self = {0};
    for (uint32_t id = 1; id <= 10; id++) {
        insert(&self, id, id);
    }
    CHECK(take(&self, 99) == 3);
}

void test_pending(void) {
    messages_are_taken_in_the_order_in_which_they_are_due();
    the_oldest_gives_way_when_nothing_is_taken();
}

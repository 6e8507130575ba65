/* Values that `configuration` keeps. */
#include "parameter_table.h"

#include <math.h>
#include <string.h>

static void set(void *values, const parameter *entry, double value) {
    memcpy((char *)values + entry->offset, &value, sizeof value);
}

void parameter_table_set_defaults(const parameter *table, size_t count, void *values) {
    for (size_t index = 0; index < count; index++) {
        set(values, &table[index], table[index].default_value);
    }
}

void parameter_table_read(const parameter *table, size_t count, const Arcade__Parameters *message, void *values) {
    for (size_t sent = 0; sent < message->n_parameters; sent++) {
        const Arcade__Parameter *received = message->parameters[sent];
        for (size_t index = 0; index < count; index++) {
            if (strcmp(table[index].name, received->name) == 0 && isfinite(received->value)) {
                set(values, &table[index], received->value);
            }
        }
    }
}

/* Values that `configuration` keeps. */
#include "parameters.h"

#include <string.h>

static void set(void *values, const parameter *entry, double value) {
    memcpy((char *)values + entry->offset, &value, sizeof value);
}

void parameters_set_defaults(const parameter *table, size_t count, void *values) {
    for (size_t index = 0; index < count; index++) {
        set(values, &table[index], table[index].default_value);
    }
}

void parameters_read(const parameter *table, size_t count, const Arcade__Parameters *message, void *values) {
    for (size_t index = 0; index < count; index++) {
        for (size_t sent = 0; sent < message->n_parameters; sent++) {
            if (strcmp(table[index].name, message->parameters[sent]->name) == 0) {
                set(values, &table[index], message->parameters[sent]->value);
            }
        }
    }
}

/* The values of the autopilot that can be changed while it runs. */
#include "parameters.h"

static const parameter TABLE[] = {
#define ENTRY(field, name, default_value) {name, offsetof(parameters, field), default_value},
    PARAMETERS(ENTRY)
#undef ENTRY
};
enum { TABLE_LENGTH = sizeof TABLE / sizeof *TABLE };

parameters parameters_default(void) {
    parameters values;
    parameter_table_set_defaults(TABLE, TABLE_LENGTH, &values);
    return values;
}

void parameters_read(parameters *self, const Arcade__Parameters *message) {
    parameter_table_read(TABLE, TABLE_LENGTH, message, self);
}

home parameters_home(const parameters *self) {
    return (home){self->home_latitude, self->home_longitude, self->home_altitude};
}

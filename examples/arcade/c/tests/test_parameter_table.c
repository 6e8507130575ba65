/* Reading parameters. */
#include "check.h"
#include "parameter_table.h"
#include "tests.h"

typedef struct gains {
    double proportional, integral;
} gains;

static const parameter TABLE[] = {
    {"gain.p", offsetof(gains, proportional), 2.0},
    {"gain.i", offsetof(gains, integral), 0.5},
};

void test_parameter_table(void) {
    gains gains;
    parameter_table_set_defaults(TABLE, 2, &gains);
    CHECK(gains.proportional == 2.0 && gains.integral == 0.5);

    Arcade__Parameter of_others = ARCADE__PARAMETER__INIT, integral = ARCADE__PARAMETER__INIT;
    of_others.name = "gain.d";
    of_others.value = 9.0;
    integral.name = "gain.i";
    integral.value = 0.75;
    Arcade__Parameter *sent[] = {&of_others, &integral};
    Arcade__Parameters message = ARCADE__PARAMETERS__INIT;
    message.n_parameters = 2;
    message.parameters = sent;
    parameter_table_read(TABLE, 2, &message, &gains);
    CHECK(gains.proportional == 2.0);
    CHECK(gains.integral == 0.75);
}

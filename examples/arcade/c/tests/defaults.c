/* The parameters that the tests fly by. */
#include "check.h"
#include "tests.h"

parameters parameters_default(void) {
    static parameters values;
    if (values.limits.fence_radius == 0.0) {
        arcade_autopilot autopilot;
        arcade_autopilot_peer autopilot_peer;
        arcade_configuration configuration;
        arcade_configuration_peer configuration_peer;
        CHECK(arcade_autopilot_test(&autopilot, &autopilot_peer) == SCL_OK);
        CHECK(arcade_configuration_test(&configuration, &configuration_peer) == SCL_OK);
        const arcade_configuration_parameters *limits = &configuration.parameters;
        values.tuning = autopilot.parameters;
        values.limits = (struct limits){
            .home = {limits->home_latitude, limits->home_longitude, limits->home_altitude},
            .fence_radius = limits->fence_radius,
            .fence_height = limits->fence_height,
            .speed = limits->speed,
            .climb = limits->climb,
        };
        arcade_autopilot_close(&autopilot, 0);
        arcade_autopilot_peer_close(&autopilot_peer, 0);
        arcade_configuration_close(&configuration, 0);
        arcade_configuration_peer_close(&configuration_peer, 0);
    }
    return values;
}

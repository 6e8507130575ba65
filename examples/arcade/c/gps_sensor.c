/* The GPS receiver: measures the simulated world, and publishes five fixes a second. */
#include "arcade_scl.h"
#include "receiver.h"

#include <inttypes.h>
#include <stdio.h>

static const int64_t SILENCE = 1000000000; /* nanoseconds without the world until it is reported */

/* One line when reception begins and ends. */
static void report(Arcade__FixQuality *last, const Arcade__Fix *fix) {
    if (fix->quality != *last && fix->quality == ARCADE__FIX_QUALITY__FIX_QUALITY_3D) {
        printf("3D fix: %u satellites\n", fix->satellites);
    } else if (fix->quality != *last) {
        printf("fix lost: %u satellites\n", fix->satellites);
    }
    *last = fix->quality;
}

/* Takes the newest parameters and limits. */
static scl_status read_parameters(arcade_gps_sensor *gates, receiver_parameters *parameters) {
    Arcade__Limits *limits;
    bool changed;
    scl_status status = arcade_gps_sensor_update_parameters(gates, 0, &changed);
    parameters->rate = gates->parameters.rate;
    if (status == SCL_OK && (status = arcade_gps_sensor_limits_latest(gates, &limits)) == SCL_OK) {
        parameters->limits = limits_from_message(limits);
        arcade_gps_sensor_limits_free(limits);
    }
    return status == SCL_NOTHING ? SCL_OK : status;
}

static scl_status run(arcade_gps_sensor *gates) {
    const double *outage_times = gates->parameters.outage;
    outage outage = {.from = outage_times[0], .until = outage_times[1]};
    receiver receiver = receiver_new(gates->parameters.seed, outage);
    receiver_parameters parameters = {0};
    Arcade__FixQuality quality = ARCADE__FIX_QUALITY__FIX_QUALITY_NONE;
    Arcade__World *world;
    Arcade__Fix fix;
    bool silent = false;
    while (true) {
        scl_status status = arcade_gps_sensor_world_recv(gates, &world, SILENCE);
        if (status == SCL_TIMEOUT) {
            if (!silent) {
                printf("fix lost: %s\n", scl_error());
            }
            silent = true;
            quality = ARCADE__FIX_QUALITY__FIX_QUALITY_NONE;
            continue;
        }
        if (status != SCL_OK) {
            return status;
        }
        silent = false;
        status = read_parameters(gates, &parameters);
        bool due = receiver_measure(&receiver, &parameters, world, &fix);
        arcade_gps_sensor_world_free(world);
        if (status == SCL_OK && due) {
            report(&quality, &fix);
            status = arcade_gps_sensor_fix_send(gates, &fix, -1);
        }
        if (status != SCL_OK) {
            return status;
        }
    }
}

int main(int count, char **arguments) {
    setlinebuf(stdout);
    if (count > 1) {
        fprintf(stderr, "error: unexpected argument `%s`\nusage: gps_sensor\n", arguments[1]);
        return 2;
    }
    arcade_gps_sensor gates;
    scl_status status = arcade_gps_sensor_open(&gates, NULL);
    if (status == SCL_OK) {
        printf("searching for satellites, noise of seed %" PRIu64 "\n", gates.parameters.seed);
        status = run(&gates);
    }
    if (status != SCL_STOPPED) {
        fprintf(stderr, "error: %s\n", scl_error());
        return 1;
    }
    arcade_gps_sensor_close(&gates, 1000000000);
    return 0;
}

/*
 * A local tangent plane around home, with the earth's radii of curvature there (Groves, Principles of GNSS, Inertial
 * and Multisensor Integrated Navigation Systems, 2nd edition, equations 2.105, 2.106 and 2.111). Wrong by less than 0.1
 * m within 1 km, and not for use at the poles.
 */
#include "geodesy.h"

#include <math.h>

static const double EQUATORIAL_RADIUS = 6378137.0;            /* metres, WGS 84 */
static const double ECCENTRICITY_SQUARED = 6.69437999014e-3; /* WGS 84 */
static const double RADIANS = 3.141592653589793 / 180.0;

/* Metres for each degree of latitude and longitude. */
typedef struct scale {
    double latitude, longitude;
} scale;

static scale scale_at(home origin) {
    double sine = sin(origin.latitude * RADIANS);
    double flattened = 1.0 - ECCENTRICITY_SQUARED * sine * sine;
    double meridian = EQUATORIAL_RADIUS * (1.0 - ECCENTRICITY_SQUARED) / (flattened * sqrt(flattened));
    double transverse = EQUATORIAL_RADIUS / sqrt(flattened);
    return (scale){
        .latitude = (meridian + origin.altitude) * RADIANS,
        .longitude = (transverse + origin.altitude) * cos(origin.latitude * RADIANS) * RADIANS,
    };
}

geodetic_position geodesy_from_local(home origin, local_position position) {
    scale metres = scale_at(origin);
    return (geodetic_position){
        .latitude = origin.latitude + position.north / metres.latitude,
        .longitude = origin.longitude + position.east / metres.longitude,
        .altitude = origin.altitude + position.up,
    };
}

local_position geodesy_to_local(home origin, geodetic_position position) {
    scale metres = scale_at(origin);
    return (local_position){
        .east = (position.longitude - origin.longitude) * metres.longitude,
        .north = (position.latitude - origin.latitude) * metres.latitude,
        .up = position.altitude - origin.altitude,
    };
}

/* Between metres east and north of home, and degrees of latitude and longitude. */
#ifndef GEODESY_H
#define GEODESY_H

typedef struct home {
    double latitude;  /* degrees */
    double longitude; /* degrees */
    double altitude;  /* metres above mean sea level */
} home;

typedef struct local_position {
    double east, north, up; /* metres from home */
} local_position;

typedef struct geodetic_position {
    double latitude, longitude; /* degrees */
    double altitude;            /* metres above mean sea level */
} geodetic_position;

geodetic_position geodesy_from_local(home origin, local_position position);
local_position geodesy_to_local(home origin, geodetic_position position);

#endif

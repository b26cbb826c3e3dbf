#include <dmumps_c.h>
#include <mpi.h>
#include <petscksp.h>
#include <signal.h>
#include <unistd.h>

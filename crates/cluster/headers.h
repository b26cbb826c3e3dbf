#include <mpi.h>
#include <petscksp.h>

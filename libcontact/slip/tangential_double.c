#define REAL double
#define OPS rc_shear_double
#include "tangential_body.h"

#define REAL float
#define OPS rc_shear_single
#include "tangential_body.h"

/* What a run costs: memory that is held at once, and seconds of the processor. */
#ifndef METER_H
#define METER_H

#include <stddef.h>

/* Aborts where more than `most` bytes beyond those now held are held at once; 0: no bound. */
void meter_start(size_t most);
/* Aborts when it took longer than a second. */
void meter_stop(void);

#endif

/* GSL's error handler, of which the process has one. Internal: never installed. */
#ifndef RC_HANDLER_H
#define RC_HANDLER_H

/* Between begin and end no error handler is called. When the last of the threads that are between
 * them at once has ended, the caller's handler is back in its place. */
void rc_handler_begin(void);
void rc_handler_end(void);

#endif

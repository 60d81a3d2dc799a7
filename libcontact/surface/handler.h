/* SPDX-License-Identifier: GPL-3.0-or-later */
/* GSL's error handler, one per process. Internal: never installed. */
#ifndef RC_HANDLER_H
#define RC_HANDLER_H

/* Between begin and end no error handler is called. When the last thread has ended, the caller's handler is
 * restored. */
void rc_handler_begin(void);
void rc_handler_end(void);

#endif

/* Figures for people: a few digits and the prefix that brings the number nearest to 1..1000. */
#ifndef RC_HUMAN_H
#define RC_HUMAN_H

enum {
    HUMAN_SIZE = 48
};

/* "1.29 u": the unit, one that takes prefixes or any other, is left to be written after it. */
const char *human_prefixed(char text[HUMAN_SIZE], double value, const char *unit);
/* "1.29 um", for the units that people give on a command line. */
const char *human_number(char text[HUMAN_SIZE], double value, const char *unit);
/* "0.163 mm2" */
const char *human_area(char text[HUMAN_SIZE], double square_metres);

#endif

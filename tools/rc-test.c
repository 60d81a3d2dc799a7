#include "tool.h"
#include <math.h>
static struct { size_t nx; double dx; struct numbers l; } a = {.dx = NAN};
static const struct opt opts[] = {
 {.name="nx",.type=OPT_COUNT,.at=offsetof(__typeof__(a),nx),.min=1,.max=1e9,.arg="N",.help="nodes",.result=true},
 {.name="dx",.type=OPT_NUMBER,.unit=UNIT_M,.at=offsetof(__typeof__(a),dx),.above=true,.min=0,.max=INFINITY,.arg="LENGTH",.help="spacing",.result=true},
 {.name="list",.type=OPT_NUMBERS,.unit=UNIT_M,.at=offsetof(__typeof__(a),l),.arg="LIST",.help="spacing",.result=true},
 {.name=NULL}};
static const struct tool_info info={.name="rc-test",.summary="test",.operands="[FILE...]",.opts=opts,.reads=READS_STREAM,.writes=WRITES_STREAM};
int main(int argc,char**argv){ struct tool t; struct rc_grid*g; struct rc_err e; tool_start(&t,&info,argc,argv,&a);
 if (a.nx) { struct rc_shape s={a.nx,a.nx,a.dx,a.dx}; g=rc_grid_new(&s,"height","m",&e); if(!g) tool_die(&t,1,"%s",e.text); for(size_t k=0;k<a.nx*a.nx;k++) g->v[k]=(double)k; rc_grid_history(g,tool_history(&t),&e); tool_write(&t,g); rc_grid_free(g); return tool_finish(&t);} 
 while((g=tool_read(&t))){ tool_write(&t,g); rc_grid_free(g);} return tool_finish(&t);}

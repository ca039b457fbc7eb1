/* Print whether the supervisor of the gate permits the lift, before and after the sensor sees a person. */
#include <stdio.h>

#include "gate_supervisor.h"

int main(void)
{
    gate_supervisor gate;
    gate_init(&gate, NULL, NULL);
    printf("%d", gate_enabled(&gate, gate_message_lift_c_trigger));
    gate_begin(&gate);
    gate_perform(&gate, gate_message_seen_u_response);
    gate_end(&gate);
    printf("%d\n", gate_enabled(&gate, gate_message_lift_c_trigger));
    return 0;
}

/* Another package prints which events the engine of the follower permits in its initial state. */
#include <stdio.h>

#include "person_follower_controller/person_follower_supervisor.h"

int main(void)
{
    person_follower_supervisor robot;
    person_follower_init(&robot, NULL, NULL, 0);
    printf("%d", person_follower_enabled(&robot, person_follower_message_move_c_trigger));
    printf("%d\n", person_follower_enabled(&robot, person_follower_message_halt_c_trigger));
    return 0;
}

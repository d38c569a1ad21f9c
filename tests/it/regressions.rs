//! What went wrong once, each with its story.

mod a_flat_leg_of_an_h_is_not_pushed_sideways;
mod a_gap_that_rounds_to_the_tolerance_closes;
mod a_hundred_bodies_at_one_place_end;
mod a_place_used_again_inherits_nothing;
mod a_removed_body_strikes_nobody;
mod an_impact_on_the_border_of_two_sub_steps_bounces;
mod parts_that_land_together_do_not_turn;
mod tips_that_meet_do_not_spin;

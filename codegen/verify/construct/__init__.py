"""What follows from equations and what is missing beside them: a Lagrangian, T and V, balances, conserved
quantities, small motions, and what an impact law does to energy and momenta."""

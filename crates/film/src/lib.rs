//! Film: order-free accumulators, replicates, standard errors, filters, sensors.

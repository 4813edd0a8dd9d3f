"""Search a study under several readings and seeds on a cluster; here it is the cores of this machine."""

import sys

from distributed import Client, LocalCluster

import kinefront
from kinefront.dask import sweep

READINGS = {
    "as the paper": "",
    "compliance definition": '[model]\nstiffness_definition = "compliance"\n',
    "aluminium": "[material]\nyoungs_modulus_pa = 7e10\nshear_modulus_pa = 2.6e10\ndensity_kg_per_m3 = 2700\n",
}

if __name__ == "__main__":
    quick = "--quick" in sys.argv
    study = kinefront.Study.paper()
    with LocalCluster(processes=True, threads_per_worker=1, dashboard_address=None) as cluster, Client(cluster) as client:
        for search in sweep(study, READINGS, [1] if quick else range(1, 6), client, evaluations=150 if quick else 6000):
            print(f"{search.reading}, seed {search.seed}: {search.hypervolume:.1f}")

#pragma once /* seed: scan guard */
